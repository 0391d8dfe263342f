package skein.mujoco

import skein.identify.LinearSystem

/** Maps wanted accelerations to the smallest actuator controls that produce them.
  *
  * @param inverse actuators × 4: change of a control for 1 m/s² upwards, and for 1 rad/s² about front, right
  *   and down
  */
private[mujoco] final class Allocation private (inverse: Array[Array[Double]]):

  /** Change of an actuator's control that produces these accelerations. */
  def control(actuator: Int, up: Double, front: Double, right: Double, down: Double): Double =
    val row = inverse(actuator)
    row(0) * up + row(1) * front + row(2) * right + row(3) * down

private[mujoco] object Allocation:
  private val axes = Vector("lifts", "rolls", "pitches", "yaws")

  /** Computes the allocation by the pseudo-inverse, B⁺ = Bᵀ (B Bᵀ)⁻¹.
    *
    * @param effects B, 4 × actuators, row by row: change per unit of each control in upward acceleration,
    *   m/s², and in the angular accelerations about front, right and down, rad/s²
    * @return Left says what these actuators cannot do
    */
  def of(effects: Array[Array[Double]]): Either[String, Allocation] =
    val most = effects.map(row => row.map(math.abs).max)
    // A fast roll turns it about other axes a little, too.
    val turnsMost = most.drop(1).max
    val isThere   = (most(0) > 0) +: most.drop(1).map(_ > Least * turnsMost)
    axes.zip(isThere).collectFirst { case (axis, false) => axis } match
      case Some(axis) => Left(s"expected actuators that lift, roll, pitch and yaw it, none $axis it")
      case None       =>
        val scaled  = effects.zip(most).map((row, scale) => row.map(_ / scale))
        val product = Array.tabulate(4, 4)((i, j) => scaled(i).lazyZip(scaled(j)).map(_ * _).sum)
        LinearSystem
          .inverseColumns(product, Singular)
          .map: inverted =>
            Allocation(Array.tabulate(effects(0).length, 4)((actuator, axis) =>
              (0 until 4).map(k => scaled(k)(actuator) * inverted(axis)(k)).sum / most(axis)
            ))
          .toRight("expected actuators that lift, roll, pitch and yaw it each by itself")

  /** Smallest effect on an axis that counts, relative to the greatest on any axis. */
  private val Least = 1e-3

  /** Smallest pivot of a regular matrix, whose effects are at most 1. */
  private val Singular = 1e-9
