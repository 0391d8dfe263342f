package skein.mujoco

/** A model's actuators, and their measured effects.
  *
  * @param lowest lower limit of each control; −∞ if it is unlimited
  * @param highest upper limit of each control; ∞ if it is unlimited
  * @param resting the value of each control closest to zero
  * @param effects acceleration by each actuator per unit of its control: upwards, m/s², about front, right
  *   and down, rad/s²
  * @param weightMps2 downward acceleration while all controls rest
  */
private[mujoco] final class MujocoActuators(
    val lowest: Array[Double],
    val highest: Array[Double],
    val resting: Array[Double],
    effects: Vector[Array[Double]],
    val weightMps2: Double,
    val allocation: Allocation
):
  val count: Int = resting.length

  private val lifting = effects.map(_(0)).toArray

  /** The rotors front right, rear left, front left, rear right, if there are exactly these four. */
  val rotors: Option[Array[Int]] =
    val corners = effects.map(effect => (math.signum(effect(1)), math.signum(effect(2))))
    val found   = MujocoActuators.Corners.map(corners.indexOf)
    Option.when(count == 4 && found.forall(_ >= 0) && lifting.forall(_ > 0))(found.toArray)

  /** The controls that hold the vehicle in hover. */
  val hovering: Array[Double] =
    Array.tabulate(count)(i => resting(i) + allocation.control(i, weightMps2, 0, 0, 0))

  /** Greatest angular acceleration about an axis in hover, rad/s²: the lesser of both directions, all
    * actuators used to their limits.
    *
    * @param axis 1 front, 2 right, 3 down
    */
  def turning(axis: Int): Double =
    def way(sign: Int) = (0 until count).map: i =>
      val share = allocation.control(
        i,
        0,
        if axis == 1 then sign else 0,
        if axis == 2 then sign else 0,
        if axis == 3 then sign else 0
      )
      val limit = if share > 0 then highest(i) else lowest(i)
      if share == 0 then 0.0 else sign * effects(i)(axis) * (limit - hovering(i))
    .sum
    way(1).min(way(-1))

  /** An actuator's full control, defined for unlimited ones too. */
  def full(actuator: Int): Double =
    if highest(actuator).isInfinite then resting(actuator) + 1 else highest(actuator)

  /** Whether these controls lift the vehicle off the ground. */
  def lifts(controls: Array[Double]): Boolean =
    var lift = 0.0
    for i <- controls.indices do lift += lifting(i) * (controls(i) - resting(i))
    lift >= weightMps2

private object MujocoActuators:
  /** Signs of each rotor's effect about the front and the right axis: front right, rear left, front left,
    * rear right.
    */
  private val Corners = Vector((-1.0, 1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0))
