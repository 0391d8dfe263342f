package skein.vehicle

/** The state of a moving car. Position and velocity are those of its centre of mass.
  *
  * @param headingRad heading, from north towards east, any number of turns
  * @param frontMps velocity along the heading, negative backwards
  * @param rightMps velocity across the heading
  * @param yawRadPerS yaw rate, clockwise seen from above
  * @param frontSlipRad deflection angle of the front tyres, positive if they push to the right; `rearSlipRad`
  *   likewise
  * @param steeredRad angle of the front wheels, positive to the right
  */
final case class CarState(
    northM: Double,
    eastM: Double,
    headingRad: Double,
    frontMps: Double = 0,
    rightMps: Double = 0,
    yawRadPerS: Double = 0,
    frontSlipRad: Double = 0,
    rearSlipRad: Double = 0,
    steeredRad: Double = 0
):
  def northMps: Double = frontMps * StrictMath.cos(headingRad) - rightMps * StrictMath.sin(headingRad)
  def eastMps: Double  = frontMps * StrictMath.sin(headingRad) + rightMps * StrictMath.cos(headingRad)

/** The driver's controls.
  *
  * @param throttle throttle, −1 to 1; negative drives backwards
  * @param steering steering, from −1, full lock to the left, to 1
  * @param brake brake, 0 to 1
  */
final case class CarControls(throttle: Double, steering: Double, brake: Double)

object CarControls:
  val Stop: CarControls = CarControls(0, 0, 1)

  /** No control is applied: the car rolls to a stop. */
  val Neutral: CarControls = CarControls(0, 0, 0)
