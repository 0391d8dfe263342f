package skein.airsim.wire

/** A camera's pose (in its vehicle's frame, whose origin is the vehicle's start, NED), its horizontal field
  * of view in degrees, and its projection matrix.
  */
final private[skein] case class CameraInfo(pose: Pose, fov: Float, proj_mat: ProjectionMatrix)
    derives Fields

/** A projection matrix of four rows with four numbers each. */
final private[skein] case class ProjectionMatrix(matrix: Seq[Seq[Float]]) derives Fields
