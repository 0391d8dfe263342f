package skein.policy

/** A closed circuit of two straights joined by two half circles, clockwise from above: from the origin north,
  * a half turn to the right, south on the line two radii further east, and another half turn to the right. A
  * place on the circuit is the length of the path from the origin to it.
  */
final case class Racetrack(straightM: Double, radiusM: Double):
  require(straightM >= 0 && radiusM > 0, s"not a circuit: straights of $straightM m, turns of $radiusM m")

  private val turnM = math.Pi * radiusM

  val lengthM: Double = 2 * (straightM + turnM)

  /** The point on the circuit nearest to a given point, m along the circuit, from 0 up to [[lengthM]]. */
  def nearest(northM: Double, eastM: Double): Double =
    if northM > straightM then straightM + radiusM * StrictMath.atan2(northM - straightM, radiusM - eastM)
    else if northM < 0 then
      2 * straightM + turnM + radiusM * StrictMath.atan2(-northM, eastM - radiusM)
    else if eastM < radiusM then northM
    else straightM + turnM + (straightM - northM)

  /** North and east of a place on the circuit, m from the origin. */
  def point(placeM: Double): (Double, Double) =
    val along = lap(placeM)
    if along < straightM then (along, 0)
    else if along < straightM + turnM then
      val angle = (along - straightM) / radiusM
      (straightM + radiusM * StrictMath.sin(angle), radiusM * (1 - StrictMath.cos(angle)))
    else if along < 2 * straightM + turnM then (2 * straightM + turnM - along, 2 * radiusM)
    else
      val angle = (along - 2 * straightM - turnM) / radiusM
      (-radiusM * StrictMath.sin(angle), radiusM * (1 + StrictMath.cos(angle)))

  /** Direction of flight at a place, from north towards east. */
  def headingRad(placeM: Double): Double =
    val along = lap(placeM)
    if along < straightM then 0
    else if along < straightM + turnM then (along - straightM) / radiusM
    else if along < 2 * straightM + turnM then math.Pi
    else math.Pi + (along - 2 * straightM - turnM) / radiusM

  /** Curvature at a place, rad per metre of path, positive to the right. */
  def curvaturePerM(placeM: Double): Double =
    val along = lap(placeM)
    if along < straightM || along >= straightM + turnM && along < 2 * straightM + turnM then 0
    else 1 / radiusM

  private def lap(placeM: Double): Double = placeM - lengthM * math.floor(placeM / lengthM)
