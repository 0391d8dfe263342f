package skein.simulator

import scala.collection.mutable
import skein.airsim.wire.{LidarData, Pose}
import skein.scene.Lidar
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

/** A scan that has been taken.
  *
  * @param pose the lidar's pose, in the frame of its vehicle's start
  * @param cast computes the points, on first use
  */
final private[simulator] class Scan(val at: Instant, val count: Long, pose: Pose, cast: () => Lidar.Points):
  private lazy val points = cast()

  /** @param idOf the items' segmentation ids
    */
  def data(idOf: Int => Int): LidarData = LidarData(at, points.xyz, pose, points.items.map(idOf))
