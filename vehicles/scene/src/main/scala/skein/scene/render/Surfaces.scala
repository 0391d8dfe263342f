package skein.scene.render

import skein.scene.{Item, Solid}
import skein.units.Vector3

/** The projected faces that may be visible in a view: for each the rows that it covers, its first and last
  * pixel in each, and its inverse depth, which is linear on the image: a·x + b·y + c at the pixel (x, y)'s
  * upper left corner, 1/m.
  *
  * A pixel belongs to a face if the pixel's middle does, so that faces that share an edge neither overlap
  * there nor leave a gap.
  */
final private[render] class Surfaces(view: View):
  import view.{focalPx, height, place, width}

  private val middleX  = width / 2.0
  private val middleY  = height / 2.0
  private val slopeX   = math.sqrt(focalPx * focalPx + middleX * middleX)
  private val slopeY   = math.sqrt(focalPx * focalPx + middleY * middleY)
  private var capacity = 256

  var count  = 0
  var faces  = new Array[Solid.Face](capacity)
  var items  = new Array[Int](capacity)
  var a      = new Array[Double](capacity)
  var b      = new Array[Double](capacity)
  var c      = new Array[Double](capacity)
  var top    = new Array[Int](capacity)
  var bottom = new Array[Int](capacity)

  // Left and right of each row, one after another; a face's begin at `first`.
  var first = new Array[Int](capacity)
  var spans = new Array[Int](1 << 14)

  private var used    = 0
  private var ahead   = new Array[Double](16)
  private var right   = new Array[Double](16)
  private var down    = new Array[Double](16)
  private val screenX = new Array[Double](Surfaces.MostCorners)
  private val screenY = new Array[Double](Surfaces.MostCorners)

  /** Adds the faces of a body that face the camera. */
  def add(solid: Solid): Unit =
    if mayBeSeen(solid) then
      locate(solid)
      var i = 0
      while i < solid.faces.length do
        project(solid.faces(i), solid.item)
        i += 1

  private def mayBeSeen(solid: Solid): Boolean =
    val own = place.inside(solid.centre)
    own.x + solid.reachM > Surfaces.NearM &&
    math.abs(own.y) * focalPx - own.x * middleX < solid.reachM * slopeX &&
    math.abs(own.z) * focalPx - own.x * middleY < solid.reachM * slopeY

  private def locate(solid: Solid): Unit =
    val n = solid.corners.length / 3
    if ahead.length < n then
      ahead = new Array(n)
      right = new Array(n)
      down = new Array(n)
    val (f, r, d, p) = (place.front, place.right, place.down, place.position)
    var i            = 0
    while i < n do
      val x = solid.corners(3 * i) - p.x
      val y = solid.corners(3 * i + 1) - p.y
      val z = solid.corners(3 * i + 2) - p.z
      ahead(i) = f.x * x + f.y * y + f.z * z
      right(i) = r.x * x + r.y * y + r.z * z
      down(i) = d.x * x + d.y * y + d.z * z
      i += 1

  private def project(face: Solid.Face, item: Int): Unit =
    val normal = Vector3(face.nx, face.ny, face.nz)
    val inside = face.d - along(normal, place.position)
    if inside < 0 then
      val corners = cut(face.loop, if item == Item.Ground then Surfaces.GroundNearM else Surfaces.NearM)
      if corners >= 3 && trace(corners) then
        faces(count) = face
        items(count) = item
        a(count) = along(normal, place.right) / (focalPx * inside)
        b(count) = along(normal, place.down) / (focalPx * inside)
        c(count) = along(normal, place.front) / inside - a(count) * middleX - b(count) * middleY
        count += 1

  private def along(u: Vector3, v: Vector3): Double = u.x * v.x + u.y * v.y + u.z * v.z

  /** Projects the part of a face beyond the near plane; returns the number of its corners. */
  private def cut(loop: Array[Int], nearM: Double): Int =
    var corners = 0

    def put(x: Double, y: Double, z: Double): Unit =
      screenX(corners) = middleX + focalPx * y / x
      screenY(corners) = middleY + focalPx * z / x
      corners += 1

    var i = 0
    while i < loop.length do
      val from = loop(i)
      val to   = loop(if i + 1 < loop.length then i + 1 else 0)
      val here = ahead(from) >= nearM
      if here then put(ahead(from), right(from), down(from))
      if here != ahead(to) >= nearM then
        // Always from the corner before the plane, whatever the face's direction, so that neighbours get
        // equal cut points.
        val near = if here then from else to
        val far  = if here then to else from
        val t    = (ahead(near) - nearM) / (ahead(near) - ahead(far))
        put(
          nearM,
          right(near) + t * (right(far) - right(near)),
          down(near) + t * (down(far) - down(near))
        )
      i += 1
    corners

  /** Records the rows that a polygon on the image covers, and its extent in each; returns whether it covers
    * any.
    */
  private def trace(corners: Int): Boolean =
    var area     = 0.0
    var (x0, x1) = (Double.PositiveInfinity, Double.NegativeInfinity)
    var (y0, y1) = (Double.PositiveInfinity, Double.NegativeInfinity)
    var i        = 0
    while i < corners do
      val j = if i + 1 < corners then i + 1 else 0
      area += screenX(i) * screenY(j) - screenX(j) * screenY(i)
      x0 = math.min(x0, screenX(i))
      x1 = math.max(x1, screenX(i))
      y0 = math.min(y0, screenY(i))
      y1 = math.max(y1, screenY(i))
      i += 1
    val from = pixel(y0, height)
    val to   = pixel(y1, height)
    val seen = from < to && x0 < width && x1 > 0 && area != 0
    if seen then
      if count == capacity then grow()
      if used + 2 * (to - from) > spans.length then
        spans = java.util.Arrays.copyOf(spans, math.max(used + 2 * (to - from), 2 * spans.length))
      top(count) = from
      bottom(count) = to
      first(count) = used
      i = 0
      while i < corners do
        edge(i, if i + 1 < corners then i + 1 else 0, from, clockwise = area > 0)
        i += 1
      used += 2 * (to - from)
    seen

  private def edge(from: Int, to: Int, firstRow: Int, clockwise: Boolean): Unit =
    val falls  = screenY(from) < screenY(to)
    val upper  = if falls then from else to
    val lower  = if falls then to else from
    val slope  = (screenX(lower) - screenX(upper)) / (screenY(lower) - screenY(upper))
    val end    = pixel(screenY(lower), height)
    val offset = used + (if falls == clockwise then 1 else 0)
    var row    = pixel(screenY(upper), height)
    while row < end do
      val x = screenX(upper) + (row + 0.5 - screenY(upper)) * slope
      spans(offset + 2 * (row - firstRow)) = pixel(x, width)
      row += 1

  /** The first pixel whose middle is at or after this coordinate, clamped to the image. */
  private def pixel(at: Double, size: Int): Int = math.max(0, math.min(size, math.ceil(at - 0.5).toInt))

  private def grow(): Unit =
    capacity *= 2
    import java.util.Arrays.copyOf
    faces = copyOf(faces, capacity)
    items = copyOf(items, capacity)
    a = copyOf(a, capacity)
    b = copyOf(b, capacity)
    c = copyOf(c, capacity)
    top = copyOf(top, capacity)
    bottom = copyOf(bottom, capacity)
    first = copyOf(first, capacity)

private[render] object Surfaces:
  /** The near plane, m, as in AirSim: nothing nearer is drawn. */
  val NearM = 0.1

  /** The near plane of the ground, m: a camera that stands on the ground must see it. */
  val GroundNearM = 1e-4

  /** Maximum number of a face's corners after clipping. */
  private val MostCorners = 32
