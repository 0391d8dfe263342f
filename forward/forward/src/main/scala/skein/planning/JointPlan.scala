package skein.planning

import skein.units.eachBelow

/** One vehicle's part in a joint plan.
  *
  * @param situation its `others` are only the vehicles that the joint plan does not control
  * @param stream number of the vehicle's random stream
  */
final case class Part(objective: PlanCost, situation: Situation, stream: Long)

/** A joint plan for the vehicles of one controller: one plan for each, which takes all others into account.
  *
  * @param tracks tracks predicted for the plans
  * @param turn index of the plan to improve next
  * @param slices number of slices searched so far, for all vehicles together
  */
final case class JointPlan(plans: Vector[Plan], tracks: Vector[PredictedTrack], turn: Int, slices: Int):

  /** One vehicle's situation, with the planned tracks of all others added to those from which it keeps apart.
    */
  def situation(self: Int, part: Part): Situation = meeting(part, tracks.indices.filter(_ != self))

  /** [[situation]] with only the nearest planned tracks: at most [[JointPlan.Regarded]], and none that is out
    * of reach of all manoeuvres within the horizon.
    */
  private[planning] def nearSituation(self: Int, part: Part): Situation =
    if !part.objective.separation.isKept then part.situation
    else
      val near = tracks.indices
        .filter(_ != self)
        .map(other => (JointPlan.nearestM(tracks(self), tracks(other)), other))
        .filter(_._1 < JointPlan.ReachM)
        .sortBy(_._1)
        .take(JointPlan.Regarded)
        .map(_._2)
      meeting(part, near)

  private def meeting(part: Part, regarded: Seq[Int]): Situation =
    if !part.objective.separation.isKept then part.situation
    else part.situation.copy(others = part.situation.others ++ regarded.map(tracks))

  /** Sum of the plans' costs, each by its own objective, with all others following their plans. */
  def cost(parts: Vector[Part], dtS: Double): Double =
    parts.indices
      .map: self =>
        val part = parts(self)
        ManoeuvreRollout(situation(self, part), part.objective, dtS).fly(plans(self).manoeuvre).cost
      .sum

object JointPlan:
  /** Maximum number of other planned vehicles that a search takes into account. */
  val Regarded = 8

  /** Maximum distance from the planned track to which a manoeuvre may lead, plus the separation there, m. */
  private val ReachM = 15.0

  private def nearestM(one: PredictedTrack, other: PredictedTrack): Double =
    var least = Double.PositiveInfinity
    eachBelow(one.steps): step =>
      val (x, y) = (one.x(step) - other.x(step), one.y(step) - other.y(step))
      least = math.min(least, x * x + y * y)
    math.sqrt(least)
