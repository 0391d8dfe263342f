package skein.planning

import skein.scenario.Fence
import skein.vehicle.PlaneReading

/** What is not left.
  *
  * @param marginM kept inside of it
  */
final case class Geofence(fence: Fence, marginM: Double = 0):
  /** How far a place is outside, m; negative inside. */
  def beyond(x: Double, y: Double): Double = fence.beyondM(x, y) + marginM

  /** The costs so far, with what it costs to be at a place at the end of a step. */
  private[planning] def added(cost: Double, x: Double, y: Double): Double =
    cost + PlanCost.breach(beyond(x, y))

  /** The same, counted from another origin. */
  private[planning] def from(x: Double, y: Double): Geofence = copy(fence.from(x, y))

/** How far vehicles stay apart.
  *
  * @param minimum m, never to be gone below
  * @param margin m beyond it, within which coming nearer costs
  * @param growth of the margin with the time looked ahead, m/s: what is predicted further ahead is known less
  *   well
  * @param price per second and per square metre missing
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

/** What a manoeuvre costs; costs are in metres, so that weights compare. Of the distance to the target it
  * takes the mean over the time flown times its length, the least, and, at the end of the horizon, the
  * distance to which momentum would carry the two: with velocities that lag, a place is known only with the
  * place that its velocity leads to.
  *
  * Leaving a geofence or going below the least separation costs more than anything else, once per step, and
  * the more the further.
  *
  * Turning costs by the acceleration that it asks for, so that a vehicle which hardly moves may turn back at
  * once.
  *
  * @param distance per second and metre
  * @param closest per metre of the least distance
  * @param carried per metre of the distance carried to
  * @param capture taken off where the least distance is below the capture radius
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

  /** What a step of a manoeuvre commands, and what it costs by itself: its effort.
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

  /** What it costs to end a step so far from another vehicle.
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

  /** The distances to the target so far, with that at the end of a step. */
  private[planning] def approached(
      so: Approach,
      x: Double,
      y: Double,
      targetX: Double,
      targetY: Double
  ): Approach =
    val distance = softened(targetX - x, targetY - y)
    Approach(so.sum + distance, so.least.min(distance))

  /** What these distances cost, where the horizon ends.
    *
    * @param carriesS for so long its last velocity carries the vehicle on
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
  /** What one step costs that breaks a hard limit. */
  val Breach = 1000.0

  /** Within which hard limits count as broken already when candidates are priced, m: so that what floats find
    * within them is so in doubles.
    */
  val Guard = 0.01

  /** What a step costs that ends so far beyond a hard limit, m. */
  private[planning] def breach(beyond: Double): Double =
    if beyond + Guard > 0 then Breach * (1 + (beyond + Guard)) else 0

/** @param cost so far
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
  /** Before the first step: farther than anything is. */
  val none: Approach = Approach(0, 1e9)
