package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import scala.concurrent.Future
import skein.offboard.{MavlinkLink, MavlinkVehicle, OffboardSettings}
import skein.policy.Fleet
import skein.port.VehicleError
import skein.units.*

/** A scenario's vehicles over MAVLink, the first with system id 1. What fails, fails with [[CannotFly]].
  *
  * @param isDatagrams whether `connect` provides datagrams, and not pieces of a stream
  * @param calledOff why vehicles must no longer move to their starts
  */
private[flight] final class MavlinkFleet(
    fleet: Fleet,
    clock: Clock,
    origin: Option[GeoLocation],
    connect: () => Flow[ByteString, ByteString, ?],
    isDatagrams: Boolean,
    calledOff: () => Option[String] = () => None
)(using system: ActorSystem):
  import MavlinkFleet.*
  import system.dispatcher

  private val systems = fleet.agents.indices.map(_ + 1).toVector
  private val settings =
    // Vehicles climb to their layers first, and a team may start far apart.
    val starts = fleet.agents.map(_.startPositionNed)
    val layers = StartPositioning.LayerM * (systems.size + 1)
    OffboardSettings(
      farthestM = (starts.map(_.copy(z = 0).norm).max + AsideM).max(1000),
      highestM = (-starts.map(_.z).min + layers.max(AboveM)).max(120)
    )

  /** Brings all to their starts, over a separate connection: this is not part of the flight. */
  def prepare(): Future[Unit] =
    connected(connect(), settings).flatMap: link =>
      val starts = fleet.agents.zip(systems).map: (agent, number) =>
        val vehicle = MavlinkVehicle(link, number)
        StartPositioning.Starting(
          agent.startPositionNed,
          Approach(agent.name, vehicle, clock, calledOff),
          () => leaveGround(vehicle)
        )
      StartPositioning.fly(starts).transformWith(result => link.close().transform(_ => result))

  /** Opens the connection of the flight, and aligns the clocks over it before any decision. */
  def open(flow: Flow[ByteString, ByteString, ?]): Future[(MavlinkLink, Vector[MavlinkVehicle])] =
    connected(flow, settings.copy(exchanges = Exchanges)).map: link =>
      (link, systems.map(MavlinkVehicle(link, _)))

  private def connected(flow: Flow[ByteString, ByteString, ?], by: OffboardSettings): Future[MavlinkLink] =
    val opening = MavlinkLink.open(flow, systems, clock, origin, by, isDatagrams = isDatagrams)
    CannotFly.unless(opening)(_.message)

  private def leaveGround(vehicle: MavlinkVehicle): Future[Vector3] =
    for
      from  <- asked(vehicle.read()).map(_.value.positionNed)
      _     <- if vehicle.isArmed then Future.unit else asked(vehicle.arm())
      _     <- if vehicle.isOnGround then asked(vehicle.takeoff()) else Future.unit
      above <- if vehicle.isOnGround then risen(vehicle, from.z, MostLooks) else Future.successful(from)
    yield above

  private def risen(vehicle: MavlinkVehicle, fromDownM: Double, looks: Int): Future[Vector3] =
    asked(vehicle.read()).map(_.value.positionNed).flatMap: at =>
      if at.z < fromDownM - RisenM then Future.successful(at)
      else if looks == 0 then
        Future.failed(CannotFly("a vehicle did not leave the ground in time"))
      else after(LookEvery.toDuration, system.scheduler)(risen(vehicle, fromDownM, looks - 1))

  private def asked[A](answer: Future[Either[VehicleError, A]]): Future[A] =
    CannotFly.unless(answer)(_.message)

private object MavlinkFleet:
  /** Minimum height of the geofence above the highest start, and its distance from the farthest, m. */
  private val AboveM = 100.0
  private val AsideM = 500.0

  /** Number of TIMESYNCs before the first decision, which take 3 s. */
  private val Exchanges = 300

  /** Altitude above the ground from which a vehicle counts as flying, m. */
  private val RisenM = 1.0

  private val LookEvery = Span.ofMillis(100)
  private val MostLooks = 200
