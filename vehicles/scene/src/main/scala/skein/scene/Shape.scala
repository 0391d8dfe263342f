package skein.scene

import skein.units.Vector3

/** A convex shape around its own origin: front, right, down, m. */
enum Shape:
  /** @param half half lengths of the box, m */
  case Box(half: Vector3)

  /** An upright pole with eight sides.
    *
    * @param radiusM radius to its edges, m
    * @param halfM half of its height, m
    */
  case Pole(radiusM: Double, halfM: Double)

  /** A plate of 2 mm thickness whose front shows an AprilTag of family 36h11.
    *
    * @param sideM side of the tag's black square, which detectors call its width; a white margin of an eighth
    *   of it surrounds the square
    */
  case Tag(number: Int, sideM: Double)

  /** Corners, and for each face the loop of its corners, in either direction. */
  private[scene] def polyhedron: (Array[Vector3], Array[Array[Int]]) = this match
    case Box(half)          => Shape.box(half)
    case Tag(_, side)       => Shape.box(Vector3(Shape.PlateM / 2, side * 5 / 8, side * 5 / 8))
    case Pole(radius, half) =>
      val ring = Array.tabulate(Shape.Sides): i =>
        val angle = 2 * math.Pi * (i + 0.5) / Shape.Sides
        (radius * StrictMath.cos(angle), radius * StrictMath.sin(angle))
      val n       = Shape.Sides
      val corners = Array(-half, half).flatMap(z => ring.map((x, y) => Vector3(x, y, z)))
      val sides   = Array.tabulate(n)(i => Array(i, (i + 1) % n, n + (i + 1) % n, n + i))
      (corners, sides ++ Array(Array.range(0, n), Array.range(n, 2 * n)))

object Shape:
  private val Sides  = 8
  private val PlateM = 0.002

  /** A box's corners and faces. The front face comes first: it shows a tag's pattern. */
  private def box(half: Vector3): (Array[Vector3], Array[Array[Int]]) =
    val corners = Array.tabulate(8): i =>
      def side(bit: Int, length: Double) = if (i & bit) == 0 then -length else length
      Vector3(side(1, half.x), side(2, half.y), side(4, half.z))
    (
      corners,
      Array(
        Array(1, 3, 7, 5),
        Array(0, 2, 6, 4),
        Array(2, 3, 7, 6),
        Array(0, 1, 5, 4),
        Array(4, 5, 7, 6),
        Array(0, 1, 3, 2)
      )
    )
