package skein.fusion

import skein.units.Vector3

/** A 3×3 matrix, row by row. A symmetric and positive matrix may be a covariance, of positions in m² or of
  * velocities in m²/s².
  */
final case class Matrix3(
    xx: Double,
    xy: Double,
    xz: Double,
    yx: Double,
    yy: Double,
    yz: Double,
    zx: Double,
    zy: Double,
    zz: Double
):
  def +(o: Matrix3): Matrix3 =
    Matrix3(xx + o.xx, xy + o.xy, xz + o.xz, yx + o.yx, yy + o.yy, yz + o.yz, zx + o.zx, zy + o.zy, zz + o.zz)

  def -(other: Matrix3): Matrix3 = this + other * -1

  def *(f: Double): Matrix3 = Matrix3(xx * f, xy * f, xz * f, yx * f, yy * f, yz * f, zx * f, zy * f, zz * f)

  def *(v: Vector3): Vector3 =
    Vector3(xx * v.x + xy * v.y + xz * v.z, yx * v.x + yy * v.y + yz * v.z, zx * v.x + zy * v.y + zz * v.z)

  def *(o: Matrix3): Matrix3 =
    val (a, b, c) = (this * o.column(0), this * o.column(1), this * o.column(2))
    Matrix3(a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z)

  def transposed: Matrix3 = Matrix3(xx, yx, zx, xy, yy, zy, xz, yz, zz)

  def column(index: Int): Vector3 = index match
    case 0 => Vector3(xx, yx, zx)
    case 1 => Vector3(xy, yy, zy)
    case _ => Vector3(xz, yz, zz)

  def determinant: Double = xx * (yy * zz - yz * zy) - xy * (yx * zz - yz * zx) + xz * (yx * zy - yy * zx)

  /** The inverse, by the adjugate; the determinant must not be 0. */
  def inverse: Matrix3 = Matrix3(
    yy * zz - yz * zy,
    xz * zy - xy * zz,
    xy * yz - xz * yy,
    yz * zx - yx * zz,
    xx * zz - xz * zx,
    xz * yx - xx * yz,
    yx * zy - yy * zx,
    xy * zx - xx * zy,
    xx * yy - xy * yx
  ) * (1 / determinant)

  /** The mean of the matrix and its transpose, which restores a covariance's symmetry after rounding. */
  def symmetric: Matrix3 = (this + transposed) * 0.5

object Matrix3:
  val Zero: Matrix3 = diagonal(0)

  /** The covariance with equal variances along all axes and no correlation. */
  def diagonal(variance: Double): Matrix3 = Matrix3(variance, 0, 0, 0, variance, 0, 0, 0, variance)

  /** v vᵀ: the covariance of a vector that varies only along v, with the length of v as standard deviation.
    */
  def along(v: Vector3): Matrix3 =
    Matrix3(v.x * v.x, v.x * v.y, v.x * v.z, v.y * v.x, v.y * v.y, v.y * v.z, v.z * v.x, v.z * v.y, v.z * v.z)
