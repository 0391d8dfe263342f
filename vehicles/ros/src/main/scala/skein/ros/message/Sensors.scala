package skein.ros.message

import scala.collection.immutable.ArraySeq

/** `sensor_msgs/Imu`: orientation, rad/s and m/s² (specific force: +g upwards at rest), each with its
  * covariance.
  */
final case class Imu(
    header: Header,
    orientation: Quaternion,
    orientationCovariance: Doubles[9],
    angularVelocity: Vector3,
    angularVelocityCovariance: Doubles[9],
    linearAcceleration: Vector3,
    linearAccelerationCovariance: Doubles[9]
) derives Cdr

/** `sensor_msgs/NavSatStatus`: -1 no fix, 0 a fix; services as bits, 1 is GPS. */
final case class NavSatStatus(status: Byte, service: Short) derives Cdr

/** `sensor_msgs/NavSatFix`: degrees, and metres above the ellipsoid. */
final case class NavSatFix(
    header: Header,
    status: NavSatStatus,
    latitude: Double,
    longitude: Double,
    altitude: Double,
    positionCovariance: Doubles[9],
    positionCovarianceType: Byte
) derives Cdr

/** `sensor_msgs/Image`: rows of `step` bytes from the top; `encoding` such as `rgb8`. */
final case class Image(
    header: Header,
    height: Int,
    width: Int,
    encoding: String,
    isBigendian: Byte,
    step: Int,
    data: ArraySeq[Byte]
) derives Cdr

/** `sensor_msgs/CompressedImage`: a file of an image; `format` such as `png`. */
final case class CompressedImage(header: Header, format: String, data: ArraySeq[Byte]) derives Cdr

/** `sensor_msgs/RegionOfInterest`: the part of a camera's image that is read out. */
final case class RegionOfInterest(xOffset: Int, yOffset: Int, height: Int, width: Int, doRectify: Boolean)
    derives Cdr

/** `sensor_msgs/CameraInfo`: size, distortion `d` by its model, intrinsic matrix `k`, rectification `r` and
  * projection `p`, row by row.
  */
final case class CameraInfo(
    header: Header,
    height: Int,
    width: Int,
    distortionModel: String,
    d: ArraySeq[Double],
    k: Doubles[9],
    r: Doubles[9],
    p: Doubles[12],
    binningX: Int,
    binningY: Int,
    roi: RegionOfInterest
) derives Cdr

/** `sensor_msgs/PointField`: a field of each point; `datatype` 7 is float32. */
final case class PointField(name: String, offset: Int, datatype: Byte, count: Int) derives Cdr

/** `sensor_msgs/PointCloud2`: points of `pointStep` bytes in rows of `rowStep`. */
final case class PointCloud2(
    header: Header,
    height: Int,
    width: Int,
    fields: Vector[PointField],
    isBigendian: Boolean,
    pointStep: Int,
    rowStep: Int,
    data: ArraySeq[Byte],
    isDense: Boolean
) derives Cdr

/** `sensor_msgs/LaserScan`: ranges, m, at angles from `angleMin` on, rad. */
final case class LaserScan(
    header: Header,
    angleMin: Float,
    angleMax: Float,
    angleIncrement: Float,
    timeIncrement: Float,
    scanTime: Float,
    rangeMin: Float,
    rangeMax: Float,
    ranges: ArraySeq[Float],
    intensities: ArraySeq[Float]
) derives Cdr
