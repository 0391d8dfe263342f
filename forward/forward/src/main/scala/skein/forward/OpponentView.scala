package skein.forward

import skein.units.{Span, Vector3}

/** A vehicle's knowledge of its opponent from a source other than readings. */
private[skein] trait OpponentView:
  /** The estimate of the opponent.
    *
    * @param aheadS time until the present decision takes effect, if the vehicle's own position is predicted
    *   for that moment
    */
  def believed(aheadS: Option[Double]): OpponentView.Believed

  /** The vehicle decides, and its camera turns to this direction. */
  def turn(northM: Double, eastM: Double): Unit

private[skein] object OpponentView:
  /** An estimated position, m, and velocity, m/s, with their age. */
  final case class Believed(placeNed: Vector3, velocityNed: Vector3, age: Span)
