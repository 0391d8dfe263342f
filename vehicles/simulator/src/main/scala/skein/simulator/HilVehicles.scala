package skein.simulator

import scala.collection.mutable
import skein.hil.{AutopilotInterface, SensorTruth, Sensors}
import skein.signal.SplitMix64
import skein.units.*

/** The vehicles of a simulation with external autopilots: each autopilot's channel belongs to one vehicle.
  * The simulator's clock stops whenever sensors are due, and continues as the autopilots allow. A vehicle
  * without an autopilot is controlled by AirSim's own firmware.
  */
private[simulator] final class HilVehicles(simulation: Simulation, settings: HilSettings)
    extends PeerProtocol,
      Lockstep:
  import HilVehicles.*

  private val world     = simulation.world
  private val startedAt = world.now
  private val flown     = mutable.LinkedHashMap.empty[Long, Flown]
  private val out       = mutable.Queue.empty[(channel: Long, datagrams: Vector[Array[Byte]])]

  private var damagedBefore = 0L
  private var lost          = 0L
  private val losses        = mutable.HashMap.empty[Int, Int]

  // Wall time waited, beyond the slowdown that autopilots may cause.
  private var waited  = Span.Zero
  private var toldAt  = Option.empty[Instant]
  private var toldFor = Span.Zero

  world.holdTo(this)

  def join(channel: Long, systems: Vector[Int], isDatagrams: Boolean): Unit =
    for system <- systems.headOption; case vehicle: SimulatedMultirotor <- world.vehicles.lift(system - 1) do
      val sensors   = Sensors(SplitMix64.seedOf(settings.seed, system), settings.noise)
      val before    = losses.getOrElse(system, 0)
      val interface = settings.autopilot.interface(system, sensors, up, simulation.speed, before)
      for (other, _) <- flown.find(_._2.vehicle eq vehicle) do leave(other)
      flown(channel) = Flown(system, vehicle, interface)
      vehicle.flyBy(Some(interface.rotors))

  def leave(channel: Long): Unit = flown.remove(channel).foreach: gone =>
    damagedBefore += gone.interface.damaged
    losses(gone.system) = gone.interface.losses
    gone.vehicle.flyBy(None)

  def receive(channel: Long, bytes: Array[Byte]): Unit = flown.get(channel).foreach: one =>
    val answers = one.interface.hear(bytes, up)
    if answers.nonEmpty then out += ((channel = channel, datagrams = answers))
    one.vehicle.flyBy(Some(one.interface.rotors))

  def take(): Vector[(channel: Long, datagrams: Vector[Array[Byte]])] =
    out.removeAll().toVector

  def nextDue: Option[Instant] =
    if isWaiting then None else stop(world.now)

  def damaged: Long    = damagedBefore + interfaces.map(_.damaged).sum
  def unanswered: Long = lost

  def isWaiting: Boolean = interfaces.exists(_.isWaiting)

  def stop(until: Instant): Option[Instant] =
    interfaces.map(_.stop(until.since(startedAt))).minOption.map(startedAt + _)

  def reached(): Unit =
    for (channel, one) <- flown if startedAt + one.interface.stop(up) <= world.now do
      out += ((channel = channel, datagrams = one.interface.sense(truthOf(one))))

  def goal: Option[Instant] =
    if flown.isEmpty || interfaces.exists(_.isByClock) then None
    else if isWaiting then Some(world.now)
    else stop(world.now)

  def told(at: Instant): Unit =
    // While the machine itself was stopped, no autopilot could answer.
    val passed = toldAt.fold(Span.Zero)(at.since(_)).min(LongestLook)
    val slowed = (up - toldFor) * MostSlowdown
    toldAt = Some(at)
    toldFor = up
    waited = ((if isWaiting then waited + passed else waited) - slowed).max(Span.Zero)
    if waited >= Patience then
      waited = Span.Zero
      for one <- interfaces if one.isWaiting do
        one.giveUp()
        if !one.isWaiting then lost += 1

  private def interfaces = flown.valuesIterator.map(_.interface)

  private def up: Span = world.now.since(startedAt)

  private def truthOf(one: Flown): SensorTruth =
    val now     = world.now
    val vehicle = one.vehicle
    val place   = vehicle.locationAt(now)
    val state   = vehicle.state
    SensorTruth(
      now,
      up,
      vehicle.motionAt(now),
      // Physics does not move a vehicle that stands on the ground.
      if state.grounded then Vector3.Zero else state.accelerationNed,
      place,
      Globe.pressurePa(place.altitude.value),
      Globe.temperatureK(place.altitude.value),
      one.jumped()
    )

private[simulator] object HilVehicles:
  private final class Flown(
      val system: Int,
      val vehicle: SimulatedMultirotor,
      val interface: AutopilotInterface
  ):
    private var jumps = vehicle.jumps

    /** Whether a reset or a new position has displaced the vehicle since the last call. */
    def jumped(): Boolean =
      val before = jumps
      jumps = vehicle.jumps
      jumps != before

  /** Real time for which the clock waits for an autopilot's answer, as in PX4's plugin for Gazebo. An
    * autopilot that slows the clock by at most `MostSlowdown` never exceeds it.
    */
  private val Patience     = Span.ofSeconds(1)
  private val MostSlowdown = 150L

  private val LongestLook = Span.ofMillis(500)
