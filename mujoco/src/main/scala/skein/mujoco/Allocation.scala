package skein.mujoco

/** How actuators' controls turn a vehicle, and which controls are the least that turn it as is wanted.
  *
  * @param effects
  *   4 × actuators, row by row: what one more of each control adds to the acceleration upwards, m/s², and to the angular
  *   accelerations about front, right and down, rad/s²
  */
private[mujoco] final class Allocation(effects: Array[Array[Double]]):
  private val count = effects(0).length

  /** Actuators × 4: the pseudo-inverse, B⁺ = Bᵀ (B Bᵀ)⁻¹. */
  private val inverse: Array[Array[Double]] =
    val scales  = effects.map(row => row.map(math.abs).max)
    val scaled  = effects.zip(scales).map((row, scale) => row.map(_ / scale))
    val product = Array.tabulate(4, 4)((i, j) => scaled(i).lazyZip(scaled(j)).map(_ * _).sum)
    val solved  = Allocation.inverted(product)
    Array.tabulate(count, 4)((actuator, axis) =>
      (0 until 4).map(k => scaled(k)(actuator) * solved(k)(axis)).sum / scales(axis)
    )

  /** What is added to the control of an actuator for these accelerations. */
  def control(actuator: Int, up: Double, front: Double, right: Double, down: Double): Double =
    val row = inverse(actuator)
    row(0) * up + row(1) * front + row(2) * right + row(3) * down

private[mujoco] object Allocation:
  private val axes = Vector("lifts", "rolls", "pitches", "yaws")

  /** Or what these actuators cannot do. */
  def of(effects: Array[Array[Double]]): Either[String, Allocation] =
    val most = effects.map(row => row.map(math.abs).max)
    // A fast roll turns it about other axes a little, too.
    val turnsMost = most.drop(1).max
    val isThere   = (most(0) > 0) +: most.drop(1).map(_ > Least * turnsMost)
    axes.zip(isThere).collectFirst { case (axis, false) => axis } match
      case Some(axis) => Left(s"expected actuators that lift, roll, pitch and yaw it, none $axis it")
      case None       =>
        try Right(Allocation(effects))
        catch
          case _: ArithmeticException =>
            Left("expected actuators that lift, roll, pitch and yaw it each by itself")

  /** Of the greatest effect on any axis. */
  private val Least = 1e-3

  /** By elimination.
    *
    * @throws ArithmeticException
    *   if there is no inverse
    */
  private def inverted(matrix: Array[Array[Double]]): Array[Array[Double]] =
    val size = matrix.length
    val rows = Array.tabulate(size)(i => matrix(i) ++ Array.tabulate(size)(j => if i == j then 1.0 else 0.0))
    for column <- 0 until size do
      val pivot = (column until size).maxBy(i => math.abs(rows(i)(column)))
      val taken = rows(pivot)
      if math.abs(taken(column)) < 1e-9 then throw ArithmeticException("singular")
      rows(pivot) = rows(column)
      rows(column) = taken.map(_ / taken(column))
      for i <- 0 until size if i != column do
        val factor = rows(i)(column)
        rows(i) = rows(i).lazyZip(rows(column)).map((a, b) => a - factor * b)
    rows.map(_.drop(size))
