package skein.simulator

import scala.collection.mutable
import scala.collection.mutable.ArrayBuffer
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.airsim.wire.Pose
import skein.scene.{Bodies, Lidar, Moment, Placement, Scene}
import skein.signal.SplitMix64
import skein.units.*
import skein.vehicle.{PathFollowing, RotorcraftKind}

/** All vehicles, their moves, and the simulator's clock. It knows no wall clock: [[advanceTo]] sets the time.
  *
  * Physics keeps a grid of whole steps from `start`, while the clock may stand anywhere between two of them:
  * physics has then been stepped up to the last grid point, and readings are extrapolated from there. So the
  * clock advances by exactly the given time, and dividing it into several calls does not change the flight.
  *
  * @param start the clock's first reading
  */
final class World(
    settings: WorldSettings,
    start: Instant,
    kind: RotorcraftKind = RotorcraftKind.AirSim,
    private[simulator] var scene: Scene = Scene.Empty,
    equipment: SensorSettings = SensorSettings.None,
    sensing: Option[SimulatedSensing] = None
):
  import World.*

  private var present    = settings.vehicles.map(made)
  private val moves      = ArrayBuffer.fill(present.size)(Option.empty[Running])
  private val followed   = mutable.HashMap.empty[Int, FollowedPlan]
  private val ended      = mutable.Queue.empty[Ended]
  private val stepLength = Span.ofSeconds(kind.stepS)
  private var clock      = start
  private var nextStep   = start + stepLength
  private var truthAt    = start

  private var wind = settings.windNed

  private val pilots  = ArrayBuffer.empty[(vehicle: Int, pilot: Pilot)]
  private var pilotAt = Instant.Epoch

  private var lockstep = Option.empty[Lockstep]

  private val scans = Scans()

  private var shaped: (vehicles: Vector[SimulatedVehicle], tagM: Double, shapes: Vector[Bodies.Shaped]) =
    (Vector.empty, 0, Vector.empty)
  settings.vehicles.zipWithIndex.foreach((vehicle, index) => equip(index, vehicle))

  present.zipWithIndex.foreach((vehicle, index) => vehicle.start(start, sensing, index))
  setWind(wind)

  /** The vehicles of the settings, then those added. */
  private[simulator] def vehicles: Vector[SimulatedVehicle] = present

  /** A vehicle that accepts moves and pilots.
    *
    * @throws IllegalArgumentException if it does not
    */
  private[simulator] def multirotor(vehicle: Int): SimulatedMultirotor = vehicles(vehicle) match
    case multirotor: SimulatedMultirotor => multirotor
    case other                           =>
      throw IllegalArgumentException(s"expected a multirotor, ${other.settings.name} is a ${other.kind}")

  private def equip(index: Int, vehicle: VehicleSettings): Unit =
    for (own, lidar) <- equipment.lidars.of(vehicle) do scans.carry(Scans.Carried(index, own, lidar))

  private def made(vehicle: VehicleSettings): SimulatedVehicle =
    if vehicle.isCar then SimulatedCar(vehicle, settings.origin)
    else if vehicle.isCamera then SimulatedCamera(vehicle, settings.origin)
    else SimulatedMultirotor(vehicle, kind.make(), settings.origin)

  /** Adds a vehicle, at rest at its start. */
  private[simulator] def add(vehicle: VehicleSettings): Unit =
    val added = made(vehicle)
    added.start(clock, sensing, present.size)
    added.setWind(wind)
    moves += None
    present = present :+ added
    equip(present.size - 1, vehicle)

  def now: Instant = clock

  def step: Span = stepLength

  /** Lets a pilot fly a vehicle; all pilots take their turns at equal times. */
  private[simulator] def attach(vehicle: Int, pilot: Pilot): Unit =
    pilots += ((vehicle, pilot))
    pilotAt = clock

  /** From now on, lets a lockstep decide how time advances. */
  private[simulator] def holdTo(lockstep: Lockstep): Unit = this.lockstep = Some(lockstep)

  /** The lockstep that time depends on, if any. */
  private[simulator] def heldTo: Option[Lockstep] = lockstep

  /** Advances physics and moves to this time, in order, or as far as [[holdTo]]'s lockstep allows. Cost: 0.13
    * µs a vehicle and step.
    */
  def advanceTo(to: Instant): Unit =
    for held <- lockstep do
      def next = if held.isWaiting then None else held.stop(to)
      for stop <- Iterator.continually(next).takeWhile(_.exists(_ <= to)).flatten do
        runTo(stop)
        held.reached()
    if !lockstep.exists(_.isWaiting) then runTo(to)

  private def runTo(to: Instant): Unit =
    var due = nextTurn
    while due.exists(_._1 <= to) do
      due.foreach: (at, vehicle) =>
        stepTo(at)
        if vehicle == AllPilots then askPilots()
        else if moves(vehicle).nonEmpty then takeTurn(vehicle)
        else followed.get(vehicle).foreach(_.turn(multirotor(vehicle), clock))
      due = nextTurn
    stepTo(to)

  /** Starts a move; the vehicle must have none: [[cancelMove]] first. It may end immediately.
    *
    * @param token returned when the move ends
    */
  private[simulator] def startMove(vehicle: Int, token: Long, move: Move): Unit =
    followed.get(vehicle).foreach(_.stop(clock))
    moves(vehicle) = Some(Running(token, move, clock, clock))
    takeTurn(vehicle)

  /** Adds a plan to the vehicle's buffer; its move ends. Only multirotors have such a buffer. */
  private[simulator] def follow(vehicle: Int, sequence: Long, plan: Move.Plan): Unit =
    end(vehicle, result = false)
    val buffer = followed.getOrElseUpdate(vehicle, FollowedPlan())
    buffer.receive(sequence, plan, clock)
    if buffer.dueAt.exists(_ <= clock) then buffer.turn(multirotor(vehicle), clock)

  /** Forgets the vehicle's plans and their sequence numbers: the next plan may have any number. */
  private[simulator] def forgetPlans(vehicle: Int): Unit = followed.remove(vehicle): Unit

  /** Ends the vehicle's plans, and its move, if there is one, with false. */
  def cancelMove(vehicle: Int): Unit =
    followed.get(vehicle).foreach(_.stop(clock))
    end(vehicle, result = false)

  private[simulator] def isMoving(vehicle: Int): Boolean = moves(vehicle).nonEmpty

  /** Takes the moves that have ended since the last call. */
  def takeEnded(): Seq[Ended] = ended.removeAll()

  /** Whether [[takeEnded]] would return anything. */
  def hasEnded: Boolean = ended.nonEmpty

  /** The earliest time at which the next move can end. */
  def nextEndAt: Option[Instant] =
    moves.iterator.flatten
      .map(running => running.dueAt.max(running.startedAt + running.move.lastsAtLeast))
      .minOption

  def reset(): Unit =
    vehicles.indices.foreach(cancelMove)
    followed.clear()
    vehicles.foreach(_.reset(clock))
    scans.forget()
    scans.note(clock, scan)

  private[simulator] def placeOf(vehicle: Int, at: Instant): Placement =
    Placement(vehicles(vehicle).worldPosition(at), vehicles(vehicle).orientation)

  private[simulator] def bodies(at: Instant): Bodies =
    if (shaped.vehicles ne vehicles) || shaped.tagM != scene.vehicleTagM then
      val shapes = vehicles.zipWithIndex.map: (vehicle, index) =>
        Bodies.Shaped(vehicle.settings.name, vehicle.parts(index, scene.vehicleTagM))
      shaped = (vehicles, scene.vehicleTagM, shapes)
    Bodies(shaped.shapes, places(at))

  /** The vehicles' places, in the form that [[Bodies]] requires. */
  private[simulator] def places(at: Instant): Array[Double] =
    Bodies.places(vehicles.iterator.map(vehicle => (vehicle.worldPosition(at), vehicle.orientation)))

  /** A lidar's newest scan; one of the current instant, if it scans on request. */
  private[simulator] def scanOf(vehicle: Int, name: String, lidar: Lidar): Option[Scan] =
    if lidar.fresh then Some(scan(Scans.Carried(vehicle, name, lidar), clock, clock.toNanos))
    else scans.newest(vehicle, name)

  private def scan(carried: Scans.Carried, at: Instant, count: Long): Scan =
    val Scans.Carried(index, name, lidar) = carried
    val place                             = placeOf(index, at)
    val origin                            = vehicles(index).settings.startNed
    val moment                            = Moment(scene, bodies(at))
    // Differs between vehicles, lidars and scans.
    val noise  = SplitMix64.seedOf(SplitMix64.seedOf(index, name.hashCode), count)
    val sensor = place.outside(lidar.place)
    val pose   = Pose(sensor.position - origin, sensor.orientation)
    Scan(at, count, pose, () => lidar.scan(moment, place, moment.itemOf(index), origin, noise))

  /** Sets the velocity of the air in the world, NED, m/s. */
  def setWind(windNed: Vector3): Unit =
    wind = windNed
    vehicles.foreach(_.setWind(windNed))

  private def nextTurn: Option[(Instant, Int)] =
    var next = Option.empty[(Instant, Int)]
    for vehicle <- moves.indices; move <- moves(vehicle) do
      if next.forall(move.dueAt < _._1) then next = Some((move.dueAt, vehicle))
    for vehicle <- followers; due <- followed(vehicle).dueAt do
      if next.forall(due < _._1) then next = Some((due, vehicle))
    if pilots.nonEmpty && next.forall(pilotAt < _._1) then Some((pilotAt, AllPilots)) else next

  private def followers: Seq[Int] = if followed.isEmpty then Nil else followed.keys.toSeq.sorted

  private def askPilots(): Unit =
    for (vehicle, pilot) <- pilots; setpoint <- pilot.turn(multirotor(vehicle), clock) do
      multirotor(vehicle).command(setpoint, clock)
    pilotAt = clock + PathFollowing.Period

  private def stepTo(to: Instant): Unit =
    while nextStep <= to do
      scans.note(nextStep - Span.ofNanos(1), scan)
      vehicles.foreach(_.step(nextStep, scene))
      for to <- sensing if nextStep >= truthAt && to.isOn() do
        for vehicle <- vehicles do
          val place = vehicle.worldPosition(nextStep)
          to.truth(TruePosition(vehicle.settings.name, nextStep, nextStep.since(start), place))
        truthAt = nextStep + SimulatedSensing.TruthEvery
      nextStep = nextStep + stepLength
    clock = clock.max(to)
    scans.note(clock, scan)

  private def takeTurn(vehicle: Int): Unit =
    for running <- moves(vehicle) do
      val one = multirotor(vehicle)
      running.move.turn(one, clock.since(running.startedAt)).performed(one, clock) match
        case None         => moves(vehicle) = Some(running.copy(dueAt = clock + PathFollowing.Period))
        case Some(result) => end(vehicle, result)

  private def end(vehicle: Int, result: Boolean): Unit =
    moves(vehicle).foreach(running => ended += Ended(vehicle, running.token, result))
    moves(vehicle) = None

object World:
  /** A move that has ended, and the result that its call answers. */
  final case class Ended(vehicle: Int, token: Long, result: Boolean)

  /** Stands for all pilots, instead of a vehicle's index. */
  private val AllPilots = -1

  private case class Running(token: Long, move: Move, startedAt: Instant, dueAt: Instant)
