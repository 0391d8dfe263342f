package skein.airsim.wire

/** An object in a camera's view.
  *
  * @param box2D bounding box in the image, pixels from the upper left corner
  * @param box3D bounding box in its own frame, m
  * @param relative_pose its pose in the camera's frame: front, right, down
  */
final private[skein] case class DetectionInfo(
    name: String,
    geo_point: GeoPoint,
    box2D: Box2D,
    box3D: Box3D,
    relative_pose: Pose
) derives Fields

final private[skein] case class Vector2r(x_val: Float, y_val: Float) derives Fields
final private[skein] case class Box2D(min: Vector2r, max: Vector2r) derives Fields
final private[skein] case class Box3D(min: Vector3r, max: Vector3r) derives Fields
