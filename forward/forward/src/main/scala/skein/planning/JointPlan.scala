package skein.planning

/** One vehicle's part in a joint plan for several.
  *
  * @param situation in which `others` are only vehicles that are not planned here
  * @param stream of random numbers
  */
final case class Part(objective: PlanCost, situation: Situation, stream: Long)

/** A joint plan for vehicles of one controller: a plan each, and each considers all others.
  *
  * @param tracks predicted tracks of the plans
  * @param turn index of the plan to improve next
  * @param slices searched so far, of all together
  */
final case class JointPlan(plans: Vector[Plan], tracks: Vector[PredictedTrack], turn: Int, slices: Int):

  /** One vehicle's situation, in which it also keeps apart from the planned tracks of the others. */
  def situation(self: Int, part: Part): Situation = meeting(part, tracks.indices.filter(_ != self))

  /** [[situation]] restricted to the planned tracks that come nearest: at most [[JointPlan.Regarded]],
    * without those too far for any manoeuvre of the horizon.
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

  /** Total cost: each plan by its objective, where the others follow theirs. */
  def cost(parts: Vector[Part], dtS: Double): Double =
    parts.indices
      .map: self =>
        val part = parts(self)
        ManoeuvreRollout(situation(self, part), part.objective, dtS).fly(plans(self).manoeuvre).cost
      .sum

object JointPlan:
  /** Limit of the other vehicles that a search considers. */
  val Regarded = 8

  /** How far a manoeuvre may lead from the planned track, plus the separation there, m. */
  private val ReachM = 15.0

  private def nearestM(one: PredictedTrack, other: PredictedTrack): Double =
    var least = Double.PositiveInfinity
    var step  = 0
    while step < one.steps do
      val (x, y) = (one.x(step) - other.x(step), one.y(step) - other.y(step))
      least = math.min(least, x * x + y * y)
      step += 1
    math.sqrt(least)
