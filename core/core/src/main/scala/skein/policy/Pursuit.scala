package skein.policy

/** Proportional-derivative control with feed-forward, for a vehicle with a lag that follows a moving point:
  * the point's velocity, plus shares of the errors of position and of velocity.
  *
  * @param perS commanded speed per metre of position error
  * @param lead commanded speed per velocity error: 1 halves the time constant of a vehicle that follows its
  *   command with a lag
  */
final case class Pursuit(perS: Double = 0.6, lead: Double = 1.0):

  def along(goalM: Double, goalMps: Double, ownM: Double, ownMps: Double): Double =
    goalMps + perS * (goalM - ownM) + lead * (goalMps - ownMps)
