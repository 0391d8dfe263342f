package skein.forward

import skein.units.Vector3

/** A vehicle's knowledge of its opponent from another source than readings. */
private[skein] trait OpponentView:
  /** The opponent's estimated position, m, velocity, m/s, and the age of the estimate.
    *
    * @param aheadS time until the present decision takes effect, if the own position is predicted for that
    *   moment
    */
  def believed(aheadS: Option[Double]): (placeNed: Vector3, velocityNed: Vector3, ageS: Double)

  /** The vehicle decides, and its camera turns to this direction. */
  def turn(northM: Double, eastM: Double): Unit
