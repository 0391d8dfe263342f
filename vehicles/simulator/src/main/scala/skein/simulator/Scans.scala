package skein.simulator

import scala.collection.mutable
import skein.airsim.wire.{LidarData, Pose}
import skein.scene.{Bodies, Lidar, Moment, Placement, Scene}
import skein.units.*

/** The vehicles' lidars. Each takes one scan per revolution of the lidar, on the simulator's clock, with all
  * rays at one instant; requests return the newest. The positions of everything at that instant are stored;
  * rays are cast only when the scan is requested.
  */
final private[simulator] class Scans:
  private var lidars = Vector.empty[Scans.Carried]
  private val notes  = mutable.Map.empty[Scans.Carried, Scan]

  def carry(lidar: Scans.Carried): Unit = lidars :+= lidar

  /** Stores every scan that is due by `until`. */
  def note(until: Instant, of: (Scans.Carried, Instant, Long) => Scan): Unit =
    for lidar <- lidars if !lidar.lidar.fresh do
      var next = dueAt(lidar)
      // Of the scans that a long step has passed only the newest can be requested.
      if next.forall(_ <= until) then
        val start = next.getOrElse(until)
        val late  = until.since(start).toNanos / lidar.period.toNanos
        next = Some(start + lidar.period * late)
        val count = notes.get(lidar).fold(0L)(_.count + 1 + late)
        next.foreach(at => notes(lidar) = of(lidar, at, count))

  def newest(vehicle: Int, name: String): Option[Scan] =
    lidars.find(lidar => lidar.vehicle == vehicle && lidar.name == name).flatMap(notes.get)

  def forget(): Unit = notes.clear()

  private def dueAt(lidar: Scans.Carried): Option[Instant] = notes.get(lidar).map(_.at + lidar.period)

private[simulator] object Scans:
  final case class Carried(vehicle: Int, name: String, lidar: Lidar):
    val period: Span = Span.ofNanos(1_000_000_000L / lidar.rotationsPerSecond)

/** A scan that has been taken: everything from which its points are computed, once.
  *
  * @param noise selects the noise, which differs between vehicles, lidars and scans
  * @param origin origin of the vehicle's own frame in the world
  */
final private[simulator] class Scan(
    val at: Instant,
    val count: Long,
    noise: Long,
    lidar: Lidar,
    vehicle: Int,
    place: Placement,
    origin: Vector3,
    scene: Scene,
    vehicles: Bodies
):
  private lazy val points: Lidar.Points =
    val moment = Moment(scene, vehicles)
    lidar.scan(moment, place, moment.itemOf(vehicle), origin, noise)

  /** @param idOf the items' segmentation ids
    */
  def data(idOf: Int => Int): LidarData =
    val sensor = place.outside(lidar.place)
    LidarData(
      at,
      points.xyz,
      Pose(sensor.position - origin, sensor.orientation),
      points.items.map(idOf)
    )
