package skein.planning

import skein.scenario.Fence
import skein.vehicle.PlaneReading

/** The area that a plan must not leave.
  *
  * @param marginM kept inside of it
  */
final case class Geofence(fence: Fence, marginM: Double = 0):
  /** Distance of a place outside, m; negative inside. */
  def beyond(x: Double, y: Double): Double = fence.beyondM(x, y) + marginM

  /** Adds the cost of a position at the end of a step to the costs so far. */
  private[planning] def added(cost: Double, x: Double, y: Double): Double =
    cost + PlanCost.breach(beyond(x, y))

  /** The geofence relative to another origin. */
  private[planning] def from(x: Double, y: Double): Geofence = copy(fence.from(x, y))

/** The cost of coming near other vehicles.
  *
  * @param minimum m, a hard limit
  * @param margin m beyond it, within which coming nearer costs
  * @param growth of the margin with the time ahead, m/s: later predictions are less certain
  * @param price per second and per square metre missing
  */
final case class SeparationCost(
    minimum: Double,
    margin: Double = 1,
    growth: Double = 0.5,
    price: Double = 20
):
  require(minimum >= 0 && margin >= 0 && growth >= 0 && price >= 0, s"must not be negative: $this")

  def isKept: Boolean = minimum > 0

  /** Distance within which coming nearer costs, m. */
  def clearance(aheadS: Double): Double = minimum + margin + growth * aheadS

/** The cost of a manoeuvre, in metres, so that weights are comparable. It includes the distance to the
  * target: the integral over time, the least, and, at the end of the horizon, the distance to which momentum
  * would carry the two, because a position without its velocity says little about vehicles with lag.
  *
  * Leaving a geofence or going below the least separation costs more than anything else, once per step, and
  * the more the further.
  *
  * Turning costs by the acceleration that it asks for, so that a vehicle which hardly moves may turn back
  * immediately.
  *
  * @param distance per second and metre
  * @param closest per metre of the least distance
  * @param carried per metre of the distance carried to
  * @param capture subtracted where the least distance is below the capture radius
  * @param captureRadius m
  * @param turning per second and (m/s²)², of turn rate times commanded speed
  * @param speedChange per second and (m/s)² off the cruise speed
  * @param softness m: a distance d counts as √(d² + softness²), so that one below it costs by its square, and
  *   a vehicle that is almost there does not hurry; above 0 only where nothing is captured
  */
final case class PlanCost(
    limits: CommandLimits,
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

  // Formulas: of doubles in ManoeuvreRollout, of a block's candidates in PlanKernel. They add to the costs so far.

  /** The command of a step, with its own cost, the effort.
    *
    * @param headingRad commanded before
    * @param turnRate rad/s, for `turnS`
    * @param speed m/s
    */
  private[planning] def steered(
      cost: Double,
      headingRad: Double,
      turnRate: Double,
      speed: Double,
      turnS: Double,
      dtS: Double
  ): Steered =
    val heading       = headingRad + turnRate * turnS
    val (cos, sin)    = (StrictMath.cos(heading), StrictMath.sin(heading))
    val (aside, slow) = (turnRate * speed, speed - cruiseSpeed)
    val effort        = aside * aside * (turning * dtS) + slow * slow * (speedChange * dtS)
    Steered(cost + effort, heading, cos, sin, speed * cos, speed * sin)

  /** The cost of ending a step at this distance from another vehicle.
    *
    * @param clearance within which coming nearer costs, m
    */
  private[planning] def neared(
      cost: Double,
      x: Double,
      y: Double,
      otherX: Double,
      otherY: Double,
      clearance: Double,
      dtS: Double
  ): Double =
    val distance = StrictMath.hypot(x - otherX, y - otherY)
    val missing  = (clearance - distance).max(0)
    cost + missing * missing * (separation.price * dtS) + PlanCost.breach(separation.minimum - distance)

  /** The distances to the target so far, including the end of a step. */
  private[planning] def approached(
      so: Approach,
      x: Double,
      y: Double,
      targetX: Double,
      targetY: Double
  ): Approach =
    val distance = softened(targetX - x, targetY - y)
    Approach(so.sum + distance, so.least.min(distance))

  /** The cost of these distances at the end of the horizon.
    *
    * @param carriesS time for which its last velocity carries the vehicle
    * @param weight of the behaviour
    */
  private[planning] def ended(
      cost: Double,
      came: Approach,
      own: PlaneReading,
      target: PlaneReading,
      carriesS: Double,
      targetCarriesS: Double,
      weight: Double,
      dtS: Double
  ): Double =
    val end = softened(
      target.northM + target.northMps * targetCarriesS - own.northM - own.northMps * carriesS,
      target.eastM + target.eastMps * targetCarriesS - own.eastM - own.eastMps * carriesS
    )
    val captured = if came.least < captureRadius then capture else 0
    cost + (came.sum * (distance * dtS) + came.least * closest + end * carried - captured) * weight

  private def softened(dx: Double, dy: Double): Double =
    math.sqrt(dx * dx + (dy * dy + softness * softness))

object PlanCost:
  /** Cost of one step that breaches a hard limit. */
  val Breach = 1000.0

  /** Distance to a hard limit that already counts as a breach when candidates are priced, m: so a candidate
    * within the limits in floats is so in doubles.
    */
  val Guard = 0.01

  /** Cost of a step that ends this far beyond a hard limit, m. */
  private[planning] def breach(beyond: Double): Double =
    if beyond + Guard > 0 then Breach * (1 + (beyond + Guard)) else 0

/** The command of a step.
  *
  * @param cost so far
  * @param headingRad commanded, with its cosine and sine
  * @param northMps the commanded velocity
  */
private[planning] final case class Steered(
    cost: Double,
    headingRad: Double,
    cos: Double,
    sin: Double,
    northMps: Double,
    eastMps: Double
)

/** Distances to a target at the ends of steps: their sum and the least of them, m. */
private[planning] final case class Approach(sum: Double, least: Double)

private[planning] object Approach:
  /** Before the first step: farther than any distance. */
  val none: Approach = Approach(0, 1e9)
