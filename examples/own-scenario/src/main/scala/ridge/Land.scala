package ridge

import skein.units.Vector3

/** A ridge from west to east, m: a bell-shaped profile along north. */
final case class Land(crestNorthM: Double, crestM: Double, widthM: Double):

  def heightM(northM: Double): Double =
    val off = (northM - crestNorthM) / widthM
    crestM * StrictMath.exp(-off * off / 2)

  /** The minimum height above the ground of a line between two positions, m. */
  def clearanceM(from: Vector3, to: Vector3): Double =
    (0 to 20).map(_ / 20.0).map(share => from + (to - from) * share).map(at => -at.z - heightM(at.x)).min
