package skein.forward

import skein.units.Vector3

/** What a vehicle knows of its opponent by something else than readings. */
private[skein] trait OpponentView:
  def believed(aheadS: Option[Double]): (placeNed: Vector3, velocityNed: Vector3, ageS: Double)

  /** The vehicle decides, and looks into this direction from now on. */
  def turn(northM: Double, eastM: Double): Unit
