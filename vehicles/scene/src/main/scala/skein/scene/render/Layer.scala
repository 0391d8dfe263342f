package skein.scene.render

import skein.scene.Solid

/** One image, drawn from the faces visible in a view. */
private[render] trait Layer:
  /** Draws pixels of a row in which this face, or [[Layer.Sky]], is visible. */
  def fill(face: Int, row: Int, from: Int, until: Int): Unit

private[render] object Layer:
  val Sky: Int = -1

  /** One colour for each face; three bytes per pixel: blue, green, red. */
  final class Flat(view: View, surfaces: Surfaces, sky: Int, rgbOf: (Solid.Face, Int) => Int) extends Layer:
    val bytes: Array[Byte] = new Array[Byte](view.width * view.height * 3)

    private val colours =
      Array.tabulate(surfaces.count)(face => rgbOf(surfaces.faces(face), surfaces.items(face)))

    def fill(face: Int, row: Int, from: Int, until: Int): Unit =
      paint(bytes, (row * view.width + from) * 3, until - from, if face == Sky then sky else colours(face))

  /** The faces' own colours and painted patterns; three bytes per pixel: blue, green, red. */
  final class Lit(view: View, surfaces: Surfaces, sky: Int) extends Layer:
    private val flat = Flat(view, surfaces, sky, (face, _) => face.rgb)

    def bytes: Array[Byte] = flat.bytes

    def fill(face: Int, row: Int, from: Int, until: Int): Unit =
      val pattern = if face == Sky then null else surfaces.faces(face).pattern
      if pattern == null then flat.fill(face, row, from, until)
      else paintPattern(pattern, face, row, from, until)

    /** Paints a pattern. A position on the plate is c + p/i, where p is linear on the image and i the inverse
      * depth.
      */
    private def paintPattern(pattern: Solid.Pattern, face: Int, row: Int, from: Int, until: Int): Unit =
      val shade    = surfaces.faces(face).rgb
      val toCamera = view.place.position - pattern.origin
      val column0  = dot(pattern.across, toCamera)
      val line0    = dot(pattern.down, toCamera)
      val columnX  = dot(pattern.across, view.place.right) / view.focalPx
      val lineX    = dot(pattern.down, view.place.right) / view.focalPx
      val v        = (row + 0.5 - view.height / 2.0) / view.focalPx
      val columnY  = dot(pattern.across, view.place.front) + dot(pattern.across, view.place.down) * v
      val lineY    = dot(pattern.down, view.place.front) + dot(pattern.down, view.place.down) * v
      val inverse0 = surfaces.c(face) + surfaces.b(face) * (row + 0.5)
      var x        = from
      var at       = (row * view.width + from) * 3
      while x < until do
        val u      = x + 0.5 - view.width / 2.0
        val depth  = 1 / (inverse0 + surfaces.a(face) * (x + 0.5))
        val column = cell(column0 + depth * (columnY + columnX * u))
        val line   = cell(line0 + depth * (lineY + lineX * u))
        val colour = if pattern.white(line * Cells + column) then shade else Ink
        bytes(at) = colour.toByte
        bytes(at + 1) = (colour >> 8).toByte
        bytes(at + 2) = (colour >> 16).toByte
        x += 1
        at += 3

    private inline def cell(at: Double): Int = math.max(0, math.min(Cells - 1, at.toInt))

  /** Depth along the camera's axis, m, one value per pixel. */
  final class Planar(view: View, surfaces: Surfaces, beyond: Float) extends Layer:
    val metres: Array[Float] = new Array[Float](view.width * view.height)

    def fill(face: Int, row: Int, from: Int, until: Int): Unit =
      val start = row * view.width
      if face == Sky then java.util.Arrays.fill(metres, start + from, start + until, beyond)
      else
        val (slope, base) = line(surfaces, face, row, from)
        var i             = 0
        while i < until - from do
          metres(start + from + i) = 1f / (base + slope * i)
          i += 1

  /** Distance from the camera, m, one value per pixel. */
  final class Perspective(view: View, surfaces: Surfaces, beyond: Float) extends Layer:
    val metres: Array[Float] = new Array[Float](view.width * view.height)

    private val across = Array.tabulate(view.width): x =>
      val u = (x + 0.5 - view.width / 2.0) / view.focalPx
      (u * u).toFloat

    def fill(face: Int, row: Int, from: Int, until: Int): Unit =
      val start = row * view.width
      if face == Sky then java.util.Arrays.fill(metres, start + from, start + until, beyond)
      else
        val (slope, base) = line(surfaces, face, row, from)
        val v             = (row + 0.5 - view.height / 2.0) / view.focalPx
        val upright       = (1 + v * v).toFloat
        var i             = 0
        while i < until - from do
          metres(start + from + i) =
            math.sqrt((upright + across(from + i)).toDouble).toFloat / (base + slope * i)
          i += 1

  /** The bounding box of the pixels that show each item. */
  final class Extents(surfaces: Surfaces, items: Int) extends Layer:
    val left: Array[Int]   = Array.fill(items)(Int.MaxValue)
    val top: Array[Int]    = Array.fill(items)(Int.MaxValue)
    val right: Array[Int]  = new Array[Int](items)
    val bottom: Array[Int] = new Array[Int](items)

    def fill(face: Int, row: Int, from: Int, until: Int): Unit =
      if face != Sky then
        val item = surfaces.items(face)
        left(item) = math.min(left(item), from)
        top(item) = math.min(top(item), row)
        right(item) = math.max(right(item), until)
        bottom(item) = math.max(bottom(item), row + 1)

  private val Cells = skein.scene.AprilTag.Cells

  /** Colour of a tag's black cells, 0xrrggbb. */
  private val Ink = 0x0a0a0a

  /** Inverse depth at the middle of a row's pixel `from`, and its change from pixel to pixel. */
  private def line(surfaces: Surfaces, face: Int, row: Int, from: Int): (Float, Float) =
    val slope = surfaces.a(face)
    (slope.toFloat, (surfaces.c(face) + surfaces.b(face) * (row + 0.5) + slope * (from + 0.5)).toFloat)

  private def dot(a: skein.units.Vector3, b: skein.units.Vector3) = a.x * b.x + a.y * b.y + a.z * b.z

  /** Fills `pixels` pixels with a colour: the first ones one by one, then by copies of doubling length. */
  private def paint(bytes: Array[Byte], at: Int, pixels: Int, rgb: Int): Unit =
    val blue   = rgb.toByte
    val green  = (rgb >> 8).toByte
    val red    = (rgb >> 16).toByte
    val byHand = at + 3 * math.min(pixels, 16)
    var i      = at
    while i < byHand do
      bytes(i) = blue
      bytes(i + 1) = green
      bytes(i + 2) = red
      i += 3
    val end = at + 3 * pixels
    while i < end do
      val more = math.min(i - at, end - i)
      System.arraycopy(bytes, at, bytes, i, more)
      i += more
