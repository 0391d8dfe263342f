package skein.simulator

import java.nio.file.Path
import skein.airsim.WorldSettings
import skein.hil.AutopilotInterface
import skein.link.Address
import skein.port.Moves
import skein.rpc.{FrameLimits, ServerLimits}
import skein.scene.Scene
import skein.units.*
import skein.vehicle.RotorcraftKind

/** How AirSim's server deals with moves that come faster than they end; see [[Workers]]. */
enum Overload:
  /** As AirSim does, with this many workers. */
  case Workers(count: Int)

  /** As AirSim does, with its number: one worker for each vehicle and four more. */
  case AirSim

  /** Not at all: the newest move wins at once and nothing waits. */
  case Never

/** What a built-in simulator is.
  *
  * @param address where it listens; port 0 takes a free one
  * @param speed of its clock against the machine's, on top of the settings' `ClockSpeed`
  * @param patience for how long moves may hold all workers, taken together, beyond moments of 100 ms; then no
  *   call waits behind moves any more. None: for ever, as AirSim
  * @param losesCancel asked whenever a move comes that replaces another, for tests of clients: where it says
  *   so, the other one is not cancelled. AirSim loses a cancel that comes while a move is about to begin
  * @param scene what stands in the world
  * @param mavlink where its vehicles are reached by MAVLink, too
  * @param hil which autopilots outside fly its vehicles; then they are not reached by MAVLink
  * @param kind what its multirotors are; without one, AirSim's quadrotors
  * @param grids the folder for voxel grids that clients ask for; without one, none is written
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
    grids: Option[Path] = None
):
  require(mavlink.isEmpty || hil.isEmpty, "vehicles have one autopilot each: MAVLink's or one outside")
  require(speed > 0 && world.clockSpeed > 0, s"speeds must be positive: $speed, ${world.clockSpeed}")

  /** What the vehicles carry; nothing, where the file's text cannot be read: [[SettingsFile]] says so.
    */
  private[simulator] def equipment: SensorSettings =
    SensorSettings.read(world.text).getOrElse(SensorSettings.None)

  /** Autopilots outside want their sensors at whole milliseconds. */
  private[simulator] def multirotors: RotorcraftKind =
    kind.getOrElse(if hil.isEmpty then RotorcraftKind.AirSim else RotorcraftKind.at(AutopilotInterface.Step))

  private[simulator] def newWorkers[Job, Flight](): Workers[Job, Flight] =
    val vehicles = world.vehicles.size
    overload match
      case Overload.Workers(count) => Workers(count, vehicles, Moves.Handover)
      case Overload.AirSim         => Workers(vehicles + 4, vehicles, Moves.Handover)
      case Overload.Never          => Workers(Int.MaxValue, vehicles, Span.Zero)

object SimulatorSettings:
  /** AirSim's. */
  val UsualPort = 41451

  /** Requests are small: the largest, a path, has 14 values a point. At most 384 MiB are held for all
    * clients: images.
    */
  val Limits: ServerLimits = ServerLimits(
    frame = FrameLimits(frameBytes = 4 << 20, elements = 1 << 17, maps = 1 << 14),
    heldBytesInCommon = 256 << 20
  )
