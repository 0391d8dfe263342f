package skein.scene

import skein.units.Vector3

/** A convex body in the world, as faces. Immutable.
  *
  * @param item the item that it is a part of, by [[Moment]]'s numbering
  * @param corners x, y, z of each, NED, m
  */
final private[skein] class Solid private (
    val item: Int,
    val corners: Array[Double],
    val faces: Array[Solid.Face],
    val centre: Vector3,
    val reachM: Double
):

  /** The distance at which a ray enters the body, in lengths of the direction: 0 from inside, infinite if not
    * within `limit`.
    */
  def hit(ox: Double, oy: Double, oz: Double, dx: Double, dy: Double, dz: Double, limit: Double): Double =
    var enter = 0.0
    var leave = limit
    var i     = 0
    while i < faces.length do
      val face  = faces(i)
      val speed = face.nx * dx + face.ny * dy + face.nz * dz
      val ahead = face.d - (face.nx * ox + face.ny * oy + face.nz * oz)
      if speed < 0 then enter = math.max(enter, ahead / speed)
      else if speed > 0 then leave = math.min(leave, ahead / speed)
      else if ahead < 0 then leave = -1
      if enter > leave then i = faces.length else i += 1
    if enter > leave then Double.PositiveInfinity else enter

private[skein] object Solid:

  /** One face of a body.
    *
    * @param nx unit normal outwards; inside is where n·p ≤ `d`
    * @param loop corners, counter-clockwise seen from outside
    * @param rgb colour in the scene's light, 0xrrggbb
    */
  final class Face(
      val nx: Double,
      val ny: Double,
      val nz: Double,
      val d: Double,
      val loop: Array[Int],
      val rgb: Int,
      val pattern: Pattern | Null
  )

  /** Cells painted on a face.
    *
    * @param origin upper left corner of the upper left cell
    * @param across vector to the next column's corner, divided by the squared length of a cell, so that its
    *   dot product with a position is the position's column; `down` is the vector for rows
    */
  final class Pattern(val white: Array[Boolean], val origin: Vector3, val across: Vector3, val down: Vector3)

  def apply(item: Int, shape: Shape, place: Placement, rgb: Int): Solid =
    val (own, loops) = shape.polyhedron
    val corners      = own.map(place.outside)
    val faces        = loops.zipWithIndex.map: (loop, index) =>
      val Array(a, b, c) = loop.take(3).map(corners)
      val normal         = (b - a).cross(c - a) * (1 / (b - a).cross(c - a).norm)
      val outwards       = normal.dot(a - place.position) > 0
      val n              = if outwards then normal else normal * -1
      val pattern        = shape match
        case Shape.Tag(number, side) if index == 0 => painted(number, side, place)
        case _                                     => null
      Face(n.x, n.y, n.z, n.dot(a), if outwards then loop else loop.reverse, lit(rgb, n), pattern)
    new Solid(
      item,
      corners.flatMap(c => Array(c.x, c.y, c.z)),
      faces,
      place.position,
      corners.iterator.map(c => (c - place.position).norm).max
    )

  /** A square of flat ground around a position, `reachM` to each side. */
  def ground(place: Vector3, reachM: Double, rgb: Int): Solid =
    val corners =
      Array(-1, 1).flatMap(n => Array(n, -n).map(e => place + Vector3(n * reachM, e * reachM, 0)))
    val face = Face(0, 0, -1, -place.z, Array(0, 1, 2, 3), rgb, null)
    new Solid(
      Item.Ground,
      corners.flatMap(c => Array(c.x, c.y, c.z)),
      Array(face),
      place,
      2 * reachM
    )

  /** A tag's pattern, as seen from the front: its columns run to the plate's left. */
  private def painted(number: Int, side: Double, place: Placement): Pattern =
    val cell = side / 8
    val half = cell * AprilTag.Cells / 2
    Pattern(
      AprilTag.pattern(number),
      place.outside(Vector3(0, half, -half)),
      place.right * (-1 / cell),
      place.down * (1 / cell)
    )

  /** A face's colour under a sky whose light is strongest from the north-west. */
  private def lit(rgb: Int, normal: Vector3): Int =
    val light               = 0.75 + 0.25 * normal.dot(Sun)
    def channel(shift: Int) = (((rgb >> shift) & 0xff) * light + 0.5).toInt << shift
    channel(16) | channel(8) | channel(0)

  private val Sun = Vector3(2.0 / 7, -3.0 / 7, -6.0 / 7)
