package skein.scene.render

import skein.scene.{Item, Moment, Solid}
import skein.units.Vector3

/** Draws a camera's view of a moment, in one pass for all kinds of images. Flat colours in one light: no
  * shadows, no haze, no lens. Deterministic: equal moments and views give equal bytes on every machine, as
  * only additions, products, quotients and square roots of floating-point numbers decide them. Cost of 1280 ×
  * 720 with 60 boxes: below 1.5 ms of one core for [[Kind.Scene]].
  */
object Renderer:

  /** @param except an item that is not drawn: the camera's carrier
    * @param idOf each item's id for segmentation, 0 to 255
    */
  def draw(
      moment: Moment,
      view: View,
      kinds: Set[Kind],
      idOf: Int => Int,
      except: Int = Item.Nothing
  ): Map[Kind, Raster] =
    val surfaces                 = seen(moment, view, except)
    val needed                   = kinds.map(_.drawnAs)
    val layers: Map[Kind, Layer] =
      needed.iterator.map(kind => kind -> layerOf(kind, moment, view, surfaces, idOf)).toMap
    Sweep(view, surfaces).run(layers.values.toArray)
    kinds.iterator.map(kind => kind -> imageOf(kind, view, layers(kind.drawnAs))).toMap

  /** The visible items, each with the bounding box of its pixels.
    *
    * @param except an item that is not drawn
    */
  def extents(moment: Moment, view: View, except: Int = Item.Nothing): Vector[Extent] =
    val surfaces = seen(moment, view, except)
    val extents  = Layer.Extents(surfaces, moment.items)
    Sweep(view, surfaces).run(Array(extents))
    (0 until moment.items).iterator
      .filter(item => extents.left(item) < extents.right(item))
      .map(item =>
        Extent(item, extents.left(item), extents.top(item), extents.right(item), extents.bottom(item))
      )
      .toVector

  private def seen(moment: Moment, view: View, except: Int): Surfaces =
    val surfaces = Surfaces(view)
    surfaces.add(ground(view.place.position, moment.scene.groundRgb))
    moment.eachSolid(solid => if solid.item != except then surfaces.add(solid))
    surfaces

  private def layerOf(kind: Kind, moment: Moment, view: View, surfaces: Surfaces, idOf: Int => Int): Layer =
    kind match
      case Kind.DepthPlanar      => Layer.Planar(view, surfaces, Raster.BeyondM)
      case Kind.DepthPerspective => Layer.Perspective(view, surfaces, Raster.BeyondM)
      case Kind.Segmentation     =>
        Layer.Flat(view, surfaces, Palette.rgb(0), (_, item) => Palette.rgb(idOf(item)))
      case Kind.Infrared       => Layer.Flat(view, surfaces, 0, (_, item) => idOf(item) * 0x010101)
      case Kind.SurfaceNormals => Layer.Flat(view, surfaces, 0x808080, (face, _) => normalRgb(face))
      case _                   => Layer.Lit(view, surfaces, moment.scene.skyRgb)

  private def imageOf(kind: Kind, view: View, layer: Layer): Raster = (kind, layer) match
    case (Kind.DepthVis, depth: Layer.Planar) => Raster.Bytes(grey(depth.metres, _ / Raster.WhiteM))
    case (Kind.DisparityNormalized, depth: Layer.Planar) =>
      val most = (Raster.BaselineM * view.focalPx / view.width).toFloat
      Raster.Numbers(depth.metres.map(most / _))
    case (_, depth: Layer.Planar)      => Raster.Numbers(depth.metres)
    case (_, depth: Layer.Perspective) => Raster.Numbers(depth.metres)
    case (_, flat: Layer.Flat)         => Raster.Bytes(flat.bytes)
    case (_, lit: Layer.Lit)           => Raster.Bytes(lit.bytes)
    case (_, other)                    => throw IllegalStateException(s"no image of $other")

  private inline def grey(values: Array[Float], inline brightness: Float => Float): Array[Byte] =
    val bytes = new Array[Byte](values.length * 3)
    var i     = 0
    while i < values.length do
      val shade = (math.min(1f, brightness(values(i))) * 255 + 0.5f).toByte
      bytes(3 * i) = shade
      bytes(3 * i + 1) = shade
      bytes(3 * i + 2) = shade
      i += 1
    bytes

  /** A face's normal as a colour: red, green and blue are north, east and up, from −1 to 1. */
  private def normalRgb(face: Solid.Face): Int =
    def channel(value: Double) = ((value + 1) * 127.5 + 0.5).toInt
    channel(face.nx) << 16 | channel(face.ny) << 8 | channel(-face.nz)

  /** A square of ground below the camera, up to the maximum visible distance. For a camera on the ground it
    * lies slightly lower: seen edge-on it would vanish, and the sky would begin at the camera.
    */
  private def ground(camera: Vector3, rgb: Int): Solid =
    val stands = math.abs(camera.z) <= Moment.GroundToleranceM
    val down   = if stands then camera.z + Moment.GroundToleranceM else 0.0
    Solid.ground(Vector3(camera.x, camera.y, down), HorizonM, rgb)

  private val HorizonM = 20_000.0
