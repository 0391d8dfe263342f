package skein.simulator

import scala.collection.mutable
import skein.autopilot.*
import skein.mavlink.{CommonDialect, Message}
import skein.units.*
import skein.vehicle.Setpoint

/** The vehicles of a simulation as MAVLink vehicles, with system numbers in their order: bytes of peers go
  * in, bytes for them come out. A vehicle that is armed by MAVLink is controlled by it until it is disarmed;
  * before and after, AirSim's API can fly it.
  */
private[simulator] final class MavlinkVehicles(simulation: Simulation, settings: MavlinkSettings)
    extends PeerProtocol:
  import MavlinkVehicles.*

  private val world      = simulation.world
  private val startedAt  = world.now
  private val autopilots = world.vehicles.indices.map(OnBoard(_)).toVector
  private val channels   = mutable.LinkedHashMap.empty[Long, MavlinkChannel]

  private var damagedBefore = 0L

  autopilots.foreach(one => world.attach(one.index, one))

  def join(channel: Long, systems: Vector[Int], isDatagrams: Boolean): Unit =
    val seen = if systems.isEmpty then autopilots.map(_.system) else systems
    channels(channel) = MavlinkChannel(seen, sinceBoot, isDatagrams)

  def leave(channel: Long): Unit = channels.remove(channel).foreach(gone => damagedBefore += gone.damaged)

  def receive(channel: Long, bytes: Array[Byte]): Unit =
    for
      peer  <- channels.get(channel)
      frame <- peer.read(bytes)
      (system, component) = targetOf(frame.message)
      one <- autopilots
      // A peer that requests more than it takes gets no answer.
      if !peer.isFull && peer.systems.contains(
        one.system
      ) && (system == 0 || system == one.system) && component <= CommonDialect.Autopilot1
    do one.hear(frame.message, (system = frame.system, component = frame.component), peer)

  def take(): Vector[(channel: Long, datagrams: Vector[Array[Byte]])] =
    val now = sinceBoot
    for (_, peer) <- channels; (system, id) <- peer.takeDue(now) do
      val one = autopilots(system - settings.firstSystem)
      for motion <- one.reported(id); message <- Telemetry.of(id, one.autopilot, motion) do
        peer.write(system, message)
    channels.iterator.map((id, peer) => (channel = id, datagrams = peer.take())).filter(
      _.datagrams.nonEmpty
    ).toVector

  def nextDue: Option[Instant] =
    channels.valuesIterator.flatMap(_.nextDue).minOption.map(startedAt + _)

  /** Frames with a wrong checksum, an unknown message or invalid content, of all peers since the start. */
  def damaged: Long = damagedBefore + channels.valuesIterator.map(_.damaged).sum

  def unanswered: Long = 0

  private def sinceBoot: Span = world.now.since(startedAt)

  private def tell(system: Int, messages: Vector[Message]): Unit =
    for message <- messages; (_, peer) <- channels do peer.write(system, message)

  private final class OnBoard(val index: Int) extends Pilot:
    val system: Int          = index + settings.firstSystem
    private val vehicle      = world.multirotor(index)
    private var decided      = Autopilot(system, vehicle.home)
    def autopilot: Autopilot = decided

    def motion: VehicleMotion = motionAt(world.now)

    /** The motion for a message of this number; None if it is about the motion, and sensors have no reading.
      */
    def reported(id: Int): Option[VehicleMotion] =
      val seen = vehicle.sensed(world.now)
      Option.unless(seen.isMissing && Telemetry.ofMotion(id)):
        VehicleMotion(world.now.since(startedAt), seen.motion, vehicle.flying)

    private def motionAt(at: Instant): VehicleMotion =
      VehicleMotion(at.since(startedAt), vehicle.motionAt(at), vehicle.flying)

    def turn(vehicle: SimulatedMultirotor, at: Instant): Option[Setpoint] =
      val wasArmed          = decided.isArmed
      val (heard, setpoint) = decided.steer(motionAt(at))
      decided = heard.next
      tell(system, heard.news)
      if decided.isArmed || wasArmed then
        takeOver()
        setpoint
      else None

    def hear(message: Message, from: (system: Int, component: Int), peer: MavlinkChannel): Unit =
      val heard = decided.heard(message, from, motion, reported)
      decided = heard.next
      takeOver()
      heard.answers.foreach(peer.write(system, _))
      tell(system, heard.news)
      for (id, micros) <- heard.interval do peer.setInterval(system, id, micros, sinceBoot)
      // A setpoint takes effect immediately, as a move does.
      turn(vehicle, world.now).foreach(vehicle.command(_, world.now))

    private def takeOver(): Unit =
      if decided.isArmed && !armed then
        vehicle.setApiControl(true)
        val _ = vehicle.arm(true)
      if !decided.isArmed && armed then
        val _ = vehicle.arm(false)
        vehicle.setApiControl(false)
      armed = decided.isArmed

    private var armed = false

private[simulator] object MavlinkVehicles:
  /** The system and component that a message addresses; 0 is all. */
  private def targetOf(message: Message): (system: Int, component: Int) =
    def named(name: String) = message.productElementNames.indexOf(name) match
      case -1    => 0
      case index =>
        message.productElement(index) match
          case number: Int => number
          case _           => 0
    (system = named("targetSystem"), component = named("targetComponent"))
