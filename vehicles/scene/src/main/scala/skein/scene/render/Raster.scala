package skein.scene.render

/** Kinds of images.
  *
  * @param drawnAs the kind that it is derived from
  */
enum Kind:
  /** Colours. */
  case Scene

  /** Metres along the camera's axis. */
  case DepthPlanar

  /** Metres from the camera. */
  case DepthPerspective

  /** Grey by depth along the axis: white from [[Raster.WhiteM]] on. */
  case DepthVis

  /** How far a point is apart in the images of two cameras 25 cm apart, over their width. */
  case DisparityNormalized

  /** Colours of the items' ids, by [[Palette]]. */
  case Segmentation

  /** Red, green and blue for north, east and up, each from −1 to 1. */
  case SurfaceNormals

  /** The items' ids as grey. */
  case Infrared

  private[render] def drawnAs: Kind = this match
    case DepthVis | DisparityNormalized => DepthPlanar
    case other                          => other

/** Rows from the top, without gaps. */
enum Raster:
  /** Three a pixel: blue, green, red. */
  case Bytes(bgr: Array[Byte])

  /** One a pixel. */
  case Numbers(values: Array[Float])

object Raster:
  /** The depth of the sky: the greatest that a half-precision float holds, as AirSim's depth is one. */
  val BeyondM = 65504f

  /** From this depth on [[Kind.DepthVis]] is white, as AirSim's. */
  val WhiteM = 100f

  /** Between the cameras of [[Kind.DisparityNormalized]], as AirSim's. */
  val BaselineM = 0.25

/** The least box around an item's pixels: from `left`, `top` until `right`, `bottom`. */
final case class Extent(item: Int, left: Int, top: Int, right: Int, bottom: Int)
