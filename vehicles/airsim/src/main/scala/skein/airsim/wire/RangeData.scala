package skein.airsim.wire

import skein.rpc.{Encoded, MessageWriter}
import skein.units.Instant
import upickle.default.writeMsg

/** One lidar scan.
  *
  * @param time_stamp time of the scan, on the simulator's clock
  * @param point_cloud x, y, z of each point, m, in the frame that the lidar's settings name
  * @param pose the lidar's pose, in its vehicle's frame
  * @param segmentation one id for each point; Cosys-AirSim sends names instead, which are skipped
  */
final private[skein] case class LidarData(
    time_stamp: Instant = Instant.Epoch,
    point_cloud: Array[Float] = Array.emptyFloatArray,
    pose: Pose = Pose(Vector3r.Zero, Quaternionr(1, 0, 0, 0)),
    segmentation: Array[Int] = Array.emptyIntArray
) derives Fields

private[skein] object LidarData:
  /** Encodes the answer to `getLidarData`, keys in AirSim's order. */
  def encode(scan: LidarData): Encoded = MessageWriter.encode: out =>
    val small = scan.copy(point_cloud = Array.emptyFloatArray, segmentation = Array.emptyIntArray)
    out.structure(writeMsg(small)):
      case "point_cloud"  => out.floats(scan.point_cloud)
      case "segmentation" => out.integers(scan.segmentation)

/** Distances in m; `relative_pose` is the sensor's, on its vehicle. */
final private[skein] case class DistanceSensorData(
    time_stamp: Instant,
    distance: Float,
    min_distance: Float,
    max_distance: Float,
    relative_pose: Pose
) derives Fields
