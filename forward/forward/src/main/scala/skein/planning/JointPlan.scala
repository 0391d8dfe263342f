package skein.planning

/** One vehicle's part in a plan that is made for several together.
  *
  * @param situation in which `others` are only those of whom nothing is planned here
  * @param stream of random numbers
  */
final case class Part(objective: PlanCost, situation: Situation, stream: Long)

/** What is planned for vehicles of one controller: a plan each, and each knows all others.
  *
  * @param tracks the ways that the plans lead
  * @param turn which of them is improved next
  * @param slices searched so far, of all together
  */
final case class JointPlan(plans: Vector[Plan], tracks: Vector[PredictedTrack], turn: Int, slices: Int):

  /** One vehicle's situation, in which it keeps apart from the planned ways of the others too. */
  def situation(self: Int, part: Part): Situation = meeting(part, tracks.indices.filter(_ != self))

  /** The same with those alone whose planned ways come nearest to its own: at most [[JointPlan.Regarded]],
    * and none that stays so far away that no manoeuvre of the horizon leads there.
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

  /** What all of it costs together: each plan by its objective, where the others fly by theirs. */
  def cost(parts: Vector[Part], dtS: Double): Double =
    parts.indices
      .map: self =>
        val part = parts(self)
        ManoeuvreRollout(situation(self, part), part.objective, dtS).fly(plans(self).manoeuvre).cost
      .sum

object JointPlan:
  /** Other vehicles that a search regards. */
  val Regarded = 8

  /** How far a manoeuvre may lead from the way planned so far, and the separation to be kept there, m. */
  private val ReachM = 15.0

  private def nearestM(one: PredictedTrack, other: PredictedTrack): Double =
    var least = Double.PositiveInfinity
    var step  = 0
    while step < one.steps do
      val (x, y) = (one.x(step) - other.x(step), one.y(step) - other.y(step))
      least = math.min(least, x * x + y * y)
      step += 1
    math.sqrt(least)
