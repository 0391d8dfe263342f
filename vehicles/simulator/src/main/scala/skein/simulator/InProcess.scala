package skein.simulator

import skein.policy.{Action, ActionGuidance}
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.{PathFollowing, Setpoint}

/** The simulation as other parts of this process use it: it reports to an onlooker, and vehicles perform
  * actions until these end, another one replaces them, or a client moves or resets the vehicle. Then, or once
  * no action is left, a vehicle in the air holds its position, as after any move.
  *
  * @param step interval at which the clock waits for commands ([[CommandLockstep]]); without one it does not
  */
private[simulator] final class InProcess(
    simulation: Simulation,
    onlooker: Onlooker,
    step: Option[Span] = None
):
  private val world  = simulation.world
  private val pilots = world.vehicles.indices.map(OnBoard(_)).toVector
  private var seenAt = Option.empty[Instant]

  private val lockstep = step.map(CommandLockstep(_, world.step, () => world.now))

  pilots.foreach(pilot => world.attach(pilot.index, pilot))
  lockstep.foreach(world.holdTo)

  /** When the onlooker sees the vehicles next, on the simulator's clock; None: not before a command. */
  def nextDue: Option[Instant] =
    Option.unless(lockstep.exists(_.isWaiting))(seenAt.fold(world.now)(_ + PathFollowing.Period))

  /** What became of the commands that the clock waits for. */
  def commands: CommandCounts =
    lockstep.fold(CommandCounts.Zero)(clock => CommandCounts(clock.missed, clock.late))

  /** Lets a vehicle perform an action; see [[SimulatorServer.act]]. */
  def act(
      vehicle: Int,
      action: Kinematics => Action,
      lasts: Option[Span],
      stamp: Option[Instant] = None
  ): Unit = lockstep.zip(stamp.filter(_ <= world.now)) match
    case Some((clock, at)) => clock.heard(vehicle, at)(pilots(vehicle).act(action, lasts))
    case None              => pilots(vehicle).act(action, lasts)

  private def see(at: Instant): Unit =
    seenAt = Some(at)
    if lockstep.forall(_.isSeen(at)) then onlooker.see(at, world.vehicles.flatMap(motionOf(_, at)))

  private def motionOf(vehicle: SimulatedVehicle, at: Instant) =
    val seen = vehicle.sensed(at)
    Option.unless(seen.isMissing)(SeenVehicle(
      vehicle.settings.name,
      vehicle.inWorld(seen.motion),
      vehicle.accelerationNed,
      vehicle.home.locate(seen.motion.positionNed)
    ))

  private final class OnBoard(val index: Int) extends Pilot:
    private var ordered = Option.empty[(action: Kinematics => Action, until: Option[Instant])]

    def act(action: Kinematics => Action, lasts: Option[Span]): Unit =
      val vehicle = world.multirotor(index)
      world.cancelMove(index)
      if !vehicle.apiControl then vehicle.setApiControl(true)
      val _ = vehicle.arm(true)
      ordered = Some((action = action, until = lasts.map(world.now + _)))
      setpoint(vehicle, world.now).foreach(vehicle.command(_, world.now))

    def turn(vehicle: SimulatedMultirotor, at: Instant): Option[Setpoint] =
      if index == 0 then see(at)
      if world.isMoving(index) || !vehicle.apiControl || ordered.exists(_.until.exists(_ <= at)) then
        ordered = None
      setpoint(vehicle, at)

    private def setpoint(vehicle: SimulatedMultirotor, at: Instant): Option[Setpoint] =
      ordered.map: (action, _) =>
        val motion = vehicle.motionAt(at)
        val now    = vehicle.inWorld(motion)
        val chosen = if vehicle.isGrounded then lifting(action(now)) else action(now)
        ActionGuidance.of(own(chosen, vehicle.settings.startNed)).setpoint(motion)

    /** Straight up at first, at [[InProcess.LiftMps]] or more: on the ground AirSim's controller can neither
      * tilt nor turn, and what it gives to these is missing in the lift.
      */
    private def lifting(action: Action): Action = action match
      case Action.Velocity(velocity, _) if velocity.z < 0 =>
        Action.Velocity(Vector3(0, 0, velocity.z.min(-InProcess.LiftMps)))
      case other => other

    /** An action in the vehicle's own frame, which begins at its start. */
    private def own(action: Action, start: Vector3): Action = action match
      case Action.Position(position, speed, yaw)     => Action.Position(position - start, speed, yaw)
      case Action.VelocityAt(north, east, down, yaw) =>
        Action.VelocityAt(north, east, Metres(down.value - start.z), yaw)
      case Action.Along(heading, speed, down, yaw) =>
        Action.Along(heading, speed, Metres(down.value - start.z), yaw)
      case other => other

private object InProcess:
  /** Slowest climb while a vehicle stands, m/s. With 0.4 and a turn it was seen to stay on the ground. */
  val LiftMps = 1.0
