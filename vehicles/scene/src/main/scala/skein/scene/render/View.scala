package skein.scene.render

import skein.scene.Placement

/** A pinhole camera that looks towards the front of its placement.
  *
  * @param fovDeg horizontal field of view, below 180
  */
final case class View(place: Placement, width: Int, height: Int, fovDeg: Double):
  require(width > 0 && height > 0 && fovDeg > 0 && fovDeg < 180, s"no view: $width × $height, $fovDeg°")

  /** Focal length: distance from the camera to the image, pixels. */
  val focalPx: Double = width / 2.0 / StrictMath.tan(StrictMath.toRadians(fovDeg) / 2)
