package skein.airsim.wire

import upickle.default.ReadWriter

/** Where a camera is (in its vehicle's frame, whose origin is the vehicle's start, NED), its horizontal field
  * of view in degrees, and what it makes of a point.
  */
final private[skein] case class CameraInfo(pose: Pose, fov: Float, proj_mat: ProjectionMatrix)
    derives ReadWriter

/** Four rows of four. */
final private[skein] case class ProjectionMatrix(matrix: Seq[Seq[Float]]) derives ReadWriter
