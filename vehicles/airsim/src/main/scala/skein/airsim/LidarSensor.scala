package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.port.{Sensor, VehicleError}
import skein.scenario.Equipment
import skein.signal.Stamped

/** A lidar as policies read it: see [[Equipment.Lidar]]. Its points must be in its own frame (`"DataFrame":
  * "SensorLocalFrame"`). Scans use connections of their own.
  *
  * @param seen called with each scan; must not block
  */
final class LidarSensor(eyes: Eyes, lidar: Equipment.Lidar, seen: Stamped[Scan] => Unit = _ => ())
    extends Sensor:
  val columns: Vector[String] = Vector("northM", "eastM", "downM") ++
    Vector.tabulate(Equipment.Sectors): sector =>
      val from = (sector * 360 / Equipment.Sectors).toString
      s"range${"0" * (3 - from.length)}${from}M"

  def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] = eyes
    .scan(lidar.name)
    .map(_.left.map(VehicleErrors.errorOf).map: frame =>
      seen(frame)
      frame.map: scan =>
        val at = scan.positionNed
        IArray(at.x, at.y, at.z) ++
          IArray.unsafeFromArray(scan.nearest(Equipment.Sectors, Equipment.BandM, lidar.rangeM)))(using
      ExecutionContext.parasitic
    )
