package skein.planning

import skein.scenario.Fence

/** What a vehicle may be commanded.
  *
  * @param minSpeed
  *   m/s
  * @param maxSpeed
  *   m/s; where both are equal, only the heading is planned
  * @param maxTurnRate
  *   rad/s
  * @param turningRadius
  *   m: the turn rate stays below speed / radius; 0 for a vehicle that turns on the spot
  */
final case class Limits(minSpeed: Double, maxSpeed: Double, maxTurnRate: Double, turningRadius: Double = 0):
  require(
    0 <= minSpeed && minSpeed <= maxSpeed && maxTurnRate >= 0 && turningRadius >= 0,
    s"limits must not be negative, the least speed not above the greatest: $this"
  )

  /** 1 / m. */
  def curvature: Double = if turningRadius > 0 then 1 / turningRadius else 1e9

  def turnRateAt(speed: Double): Double = math.min(maxTurnRate, speed * curvature)

object Limits:
  /** The paper's pursuer: always 10 m/s, and a turning circle of 8 m, so 1.25 rad/s. */
  val paperPursuer: Limits = Limits(10, 10, 1.25, 8)

/** What is not left.
  *
  * @param marginM
  *   kept inside of it
  */
final case class Geofence(fence: Fence, marginM: Double = 0):
  /** How far a place is outside, m; negative inside. */
  def beyond(x: Double, y: Double): Double = fence.beyondM(x, y) + marginM

/** How far vehicles stay apart.
  *
  * @param minimum
  *   m, never to be gone below
  * @param margin
  *   m beyond it, within which coming nearer costs
  * @param growth
  *   of the margin with the time looked ahead, m/s: what is predicted further ahead is known less well
  * @param price
  *   per second and per square metre missing
  */
final case class SeparationCost(
    minimum: Double,
    margin: Double = 1,
    growth: Double = 0.5,
    price: Double = 20
):
  require(minimum >= 0 && margin >= 0 && growth >= 0 && price >= 0, s"must not be negative: $this")

  /** Whether there is anything to be kept. */
  def isKept: Boolean = minimum > 0

  /** Within which coming nearer costs, m. */
  def clearance(aheadS: Double): Double = minimum + margin + growth * aheadS

/** What a manoeuvre costs; costs are in metres, so that weights compare. Of the distance to the target it takes the mean
  * over the time flown times its length, the least, and, at the end of the horizon, the distance to which momentum
  * would carry the two: with velocities that lag, a place is known only with the place that its velocity leads to.
  *
  * Leaving a geofence or going below the least separation costs more than anything else, once per step, and the more
  * the further.
  *
  * Turning costs by the acceleration that it asks for, so that a vehicle which hardly moves may turn back at once.
  *
  * @param distance
  *   per second and metre
  * @param closest
  *   per metre of the least distance
  * @param carried
  *   per metre of the distance carried to
  * @param capture
  *   taken off where the least distance is below the capture radius
  * @param captureRadius
  *   m
  * @param turning
  *   per second and (m/s²)², of turn rate times commanded speed
  * @param speedChange
  *   per second and (m/s)² off the cruise speed
  * @param softness
  *   m: a distance d counts as √(d² + softness²), so that one below it costs by its square, and a vehicle that is almost
  *   there does not hurry; above 0 only where nothing is captured
  */
final case class PlanCost(
    limits: Limits,
    distance: Double = 1,
    closest: Double = 0,
    carried: Double = 1,
    capture: Double = 0,
    captureRadius: Double = 1.5,
    turning: Double = 0.0001,
    speedChange: Double = 0,
    cruiseSpeed: Double = 0,
    separation: SeparationCost = SeparationCost(0),
    geofences: Vector[Geofence] = Vector.empty,
    softness: Double = 0
):
  require(
    softness == 0 || softness > 0 && capture == 0,
    s"expected no softness, or one above 0 m and no capture, came $softness m and a capture worth $capture"
  )
