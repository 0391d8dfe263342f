package skein.scene.render

/** Kinds of images.
  *
  * @param drawnAs the kind that it is derived from
  */
enum Kind:
  case Scene

  case DepthPlanar

  case DepthPerspective

  /** Depth along the axis as grey: white from [[Raster.WhiteM]] on. */
  case DepthVis

  /** Horizontal distance of a point between the images of two cameras 25 cm apart, over the images' width. */
  case DisparityNormalized

  /** Colours of the items' segmentation ids, by [[Palette]]. */
  case Segmentation

  /** Red, green and blue for north, east and up, each from −1 to 1. */
  case SurfaceNormals

  case Infrared

  private[render] def drawnAs: Kind = this match
    case DepthVis | DisparityNormalized => DepthPlanar
    case other                          => other

/** An image's values: rows from the top, without gaps. */
enum Raster:
  /** Three bytes per pixel: blue, green, red. */
  case Bytes(bgr: Array[Byte])

  case Numbers(values: Array[Float])

object Raster:
  /** The sky's depth, m: the greatest half-precision float, as AirSim's depth images are half-precision. */
  val BeyondM = 65504f

  /** The depth from which [[Kind.DepthVis]] is white, m, as in AirSim. */
  val WhiteM = 100f

  /** Distance of the cameras of [[Kind.DisparityNormalized]], m, as in AirSim. */
  val BaselineM = 0.25

/** The bounding box of an item's pixels: from `left`, `top` until `right`, `bottom`. */
final case class Extent(item: Int, left: Int, top: Int, right: Int, bottom: Int)
