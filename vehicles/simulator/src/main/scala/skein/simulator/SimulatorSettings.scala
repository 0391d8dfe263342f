package skein.simulator

import skein.airsim.WorldSettings
import skein.hil.AutopilotInterface
import skein.link.Address
import skein.port.Moves
import skein.rpc.{FrameLimits, ServerLimits}
import skein.scene.Scene
import skein.units.*
import skein.vehicle.RotorcraftKind

/** The treatment of moves that arrive faster than they end; see [[Workers]]. */
enum Overload:
  /** Moves wait as in AirSim, with this number of workers. */
  case Workers(count: Int)

  /** Moves wait as in AirSim, with its number of workers: one for each vehicle and four more. */
  case AirSim

  /** The number of workers is unlimited: the newest move replaces the older immediately, and nothing waits.
    */
  case Never

/** Settings of a built-in simulator.
  *
  * @param address listening address; port 0 takes a free one
  * @param speed ratio of its clock to the machine's, multiplied by the settings' `ClockSpeed`
  * @param patience total time for which moves may hold all workers, without moments of up to 100 ms; after
  *   that no call waits behind moves any more. None: unlimited, as in AirSim
  * @param losesCancel called whenever a move replaces another, for tests of clients: if true, the other one
  *   is not cancelled. AirSim loses a cancel that arrives while a move is about to begin
  * @param scene objects of the world
  * @param mavlink ports on which its vehicles also speak MAVLink
  * @param hil external autopilots that fly its vehicles; then these do not speak MAVLink
  * @param kind the kind of its multirotors; without one, AirSim's quadrotors
  * @param sensing errors of readings; without it they are true. External autopilots have sensors of their own
  */
final case class SimulatorSettings(
    world: WorldSettings = WorldSettings.Default,
    address: Address = Address("127.0.0.1", SimulatorSettings.UsualPort),
    overload: Overload = Overload.AirSim,
    speed: Double = 1.0,
    limits: ServerLimits = SimulatorSettings.Limits,
    losesCancel: () => Boolean = () => false,
    scene: Scene = Scene.Empty,
    mavlink: Option[MavlinkSettings] = None,
    hil: Option[HilSettings] = None,
    kind: Option[RotorcraftKind] = None,
    patience: Option[Span] = None,
    sensing: Option[SimulatedSensing] = None
):
  require(mavlink.isEmpty || hil.isEmpty, "vehicles have one autopilot each: MAVLink's or one outside")
  require(speed > 0 && world.clockSpeed > 0, s"speeds must be positive: $speed, ${world.clockSpeed}")

  /** The vehicles' sensors; none if the file's text cannot be read, which [[SettingsFile]] reports. */
  private[simulator] def equipment: SensorSettings = SensorSettings.of(world)

  /** The kind of its multirotors. External autopilots need sensor readings at whole milliseconds. */
  private[simulator] def multirotors: RotorcraftKind =
    kind.getOrElse(if hil.isEmpty then RotorcraftKind.AirSim else RotorcraftKind.at(AutopilotInterface.Step))

  private[simulator] def newWorkers[Job, Flight](): Workers[Job, Flight] =
    val vehicles = world.vehicles.size
    overload match
      case Overload.Workers(count) => Workers(count, vehicles, Moves.Handover)
      case Overload.AirSim         => Workers(vehicles + 4, vehicles, Moves.Handover)
      case Overload.Never          => Workers(Int.MaxValue, vehicles, Span.Zero)

object SimulatorSettings:
  val UsualPort = 41451

  /** Limits of its server. Requests are small: the largest, a path, has 14 values a point. At most 384 MiB,
    * mainly images, are held for all clients.
    */
  val Limits: ServerLimits = ServerLimits(
    frame = FrameLimits(frameBytes = 4 << 20, elements = 1 << 17, maps = 1 << 14),
    heldBytesInCommon = 256 << 20
  )
