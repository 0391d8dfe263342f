package skein.planning

import skein.policy.Policy
import skein.vehicle.PlaneReading

/** Predicted positions of an object at the end of each step of the horizon, m, world NED: x north, y east. */
final class PredictedTrack(xs: IArray[Double], ys: IArray[Double]):
  require(xs.length == ys.length, s"a track has as many x as y, got ${xs.length} and ${ys.length}")

  def steps: Int           = xs.length
  def x(step: Int): Double = xs(step)
  def y(step: Int): Double = ys(step)

  def lastVx(dtS: Double): Double = last(xs) / dtS
  def lastVy(dtS: Double): Double = last(ys) / dtS

  private def last(values: IArray[Double]): Double =
    if steps < 2 then 0 else values(steps - 1) - values(steps - 2)

object PredictedTrack:

  /** The track of an object that keeps its velocity. */
  def straight(from: PlaneReading, steps: Int, dtS: Double): PredictedTrack =
    PredictedTrack(
      IArray.tabulate(steps)(step => from.northM + from.northMps * dtS * (step + 1)),
      IArray.tabulate(steps)(step => from.eastM + from.eastMps * dtS * (step + 1))
    )

  /** The track of an object that keeps its speed and turn rate.
    *
    * @param turnRateRadPerS turn rate from north towards east
    */
  def turning(from: PlaneReading, turnRateRadPerS: Double, steps: Int, dtS: Double): PredictedTrack =
    if math.abs(turnRateRadPerS) < 1e-6 then straight(from, steps, dtS)
    else
      import from.{eastMps as vy, northMps as vx}
      val angles = IArray.tabulate(steps)(step => turnRateRadPerS * dtS * (step + 1))
      PredictedTrack(
        angles.map(a =>
          from.northM + (vx * StrictMath.sin(a) - vy * (1 - StrictMath.cos(a))) / turnRateRadPerS
        ),
        angles.map(a =>
          from.eastM + (vx * (1 - StrictMath.cos(a)) + vy * StrictMath.sin(a)) / turnRateRadPerS
        )
      )

  def standing(x: Double, y: Double, steps: Int): PredictedTrack =
    PredictedTrack(IArray.fill(steps)(x), IArray.fill(steps)(y))

/** The target that a vehicle must approach.
  *
  * @param carriesS time for which its last velocity carries it ([[PredictedVehicle.carriesS]]); None stands
  *   for that of the vehicle itself
  */
enum Target(val carriesS: Option[Double] = None):
  /** A vehicle that decides at each step with a policy, on present readings of both, and on the last heading
    * commanded to this vehicle.
    *
    * @param speed the speed that it commands, m/s
    * @param headingRad the heading last commanded to it
    */
  case Opponent(vehicle: PredictedVehicle[?], speed: Double, headingRad: Double, policy: Policy)
      extends Target(Some(vehicle.carriesS))

  /** An object or a place whose track does not depend on this vehicle. */
  case Along(track: PredictedTrack) extends Target()

/** One possible behaviour of the target, with its weight. */
final case class Behaviour(target: Target, weight: Double = 1)

/** The input of a plan: the joint state at the moment at which the planned command takes effect, after its
  * dead time.
  *
  * @param headingRad the heading last commanded to this vehicle
  * @param sinceDecisionS time since that command
  * @param behaviours possible behaviours of the target, equal for all candidates, so that their costs are
  *   comparable
  * @param others vehicles to keep apart from
  * @param suggested further manoeuvres that every slice tries, at most 16
  */
final case class Situation(
    own: PredictedVehicle[?],
    headingRad: Double,
    sinceDecisionS: Double,
    behaviours: Vector[Behaviour],
    others: Vector[PredictedTrack] = Vector.empty,
    suggested: Vector[Manoeuvre] = Vector.empty
):
  require(suggested.size <= 16, s"at most 16 manoeuvres may be suggested, got ${suggested.size}")
  require(sinceDecisionS >= 0, s"time since the last decision must not be negative, got $sinceDecisionS s")

  /** Time for which the first step's turn lasts, s. */
  def firstTurnS: Double = sinceDecisionS.min(Situation.LongestTurnS)

object Situation:
  /** After a longer pause, a vehicle's first turn is limited to that of this time, s. */
  private val LongestTurnS = 0.5
