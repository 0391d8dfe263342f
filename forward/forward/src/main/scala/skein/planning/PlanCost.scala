package skein.planning

import skein.scenario.Fence
import skein.vehicle.PlaneReading

/** The area that a plan must not leave.
  *
  * @param marginM distance that plans keep from its boundary, on the inside, m
  */
final case class Geofence(fence: Fence, marginM: Double = 0):
  /** Distance of a position beyond the area in which plans stay, m; negative inside. */
  private[planning] def beyond(x: Double, y: Double): Double = fence.beyondM(x, y) + marginM

  /** Adds the cost of a step's final position. */
  private[planning] def added(cost: Double, x: Double, y: Double): Double =
    cost + PlanCost.breach(beyond(x, y))

  /** The geofence in coordinates with another origin. */
  private[planning] def from(x: Double, y: Double): Geofence = copy(fence.from(x, y))

/** The cost of coming near other vehicles.
  *
  * @param minimum hard limit of the distance in plans, m
  * @param margin width of the zone beyond the minimum in which coming nearer has a cost, m
  * @param growth growth of the margin with the time ahead, m/s; later predictions are less certain
  * @param price cost per second and per square metre of missing distance
  * @param doubt part of the minimum that only plans keep: at `minimum - doubt` the limit itself is broken, m
  */
final case class SeparationCost(
    minimum: Double,
    margin: Double = 1,
    growth: Double = 0.5,
    price: Double = 20,
    doubt: Double = 0
):
  require(minimum >= 0 && margin >= 0 && growth >= 0 && price >= 0, s"must not be negative: $this")
  require(
    doubt >= 0 && doubt <= minimum,
    s"expected a doubt from 0 to the minimum of $minimum m, got $doubt m"
  )

  def isKept: Boolean = minimum > 0

  /** Distance below which coming nearer has a cost, m. */
  def clearance(aheadS: Double): Double = minimum + margin + growth * aheadS

/** The cost of a manoeuvre, in metres, so that weights are comparable. It contains three terms of the
  * distance to the target: its integral over time, its minimum, and the distance to which their momentum
  * would carry the two after the horizon, because the position alone says little about vehicles with lag.
  *
  * Every step outside a geofence or below the minimum separation costs more than everything else, and more
  * with the size of the breach.
  *
  * Turning costs by its lateral acceleration, so that a vehicle that hardly moves may turn back immediately.
  *
  * @param distance weight of the integral, per second and metre
  * @param closest weight of the minimum distance, per metre
  * @param carried weight of the distance after the horizon, per metre
  * @param capture amount subtracted if the minimum distance is below the capture radius
  * @param captureRadius distance below which the target is captured, m
  * @param turning weight of the squared lateral acceleration (turn rate times commanded speed), per second
  *   and (m/s²)²
  * @param speedChange weight of the squared difference from the cruise speed, per second and (m/s)²
  * @param softness length, m: a distance d counts as √(d² + softness²). Distances below it then cost by their
  *   square, and a vehicle that has nearly arrived does not hurry. Must be 0 if captures count
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
    s"expected no softness, or one above 0 m and no capture, got $softness m and a capture worth $capture"
  )

  // Formulas: ManoeuvreRollout evaluates them in doubles, PlanKernel for a block's candidates. Each adds to
  // the costs so far.

  /** The command of a step, with the cost of its effort added.
    *
    * @param headingRad commanded heading before the step
    * @param turnRate turn rate, rad/s, for the duration `turnS`
    * @param speed commanded speed, m/s
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

  /** Adds the cost of a step that ends at this distance from another vehicle.
    *
    * @param clearance distance below which coming nearer has a cost, m
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

  /** Adds the distance to the target at the end of a step. */
  private[planning] def approached(
      so: Approach,
      x: Double,
      y: Double,
      targetX: Double,
      targetY: Double
  ): Approach =
    val distance = softened(targetX - x, targetY - y)
    Approach(so.sum + distance, so.least.min(distance))

  /** Adds the cost of the distances at the end of the horizon.
    *
    * @param carriesS time for which the vehicle's last velocity carries it, s
    * @param weight weight of the opponent's behaviour
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

  /** Distance inside a hard limit that already counts as a breach when candidates are priced, m. A candidate
    * within the limits in floats is then within them in doubles too.
    */
  val Guard = 0.01

  /** Cost of a step that ends this far beyond a hard limit, m; 0 if it ends within the limit. */
  private[planning] def breach(beyond: Double): Double =
    if beyond + Guard > 0 then Breach * (1 + (beyond + Guard)) else 0

/** The command of a step.
  *
  * @param cost the total cost so far
  * @param headingRad commanded heading
  * @param cos cosine of the heading
  * @param sin sine of the heading
  * @param northMps north component of the commanded velocity
  */
private[planning] final case class Steered(
    cost: Double,
    headingRad: Double,
    cos: Double,
    sin: Double,
    northMps: Double,
    eastMps: Double
)

/** Distances to a target at the ends of the steps so far: their sum and their minimum, m. */
private[planning] final case class Approach(sum: Double, least: Double)

private[planning] object Approach:
  /** The value before the first step; its minimum exceeds every distance. */
  val none: Approach = Approach(0, 1e9)
