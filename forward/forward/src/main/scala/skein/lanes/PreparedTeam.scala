package skein.lanes

import scala.util.hashing.MurmurHash3
import skein.forward.{Delays, LoopTiming, RolloutAgent}
import skein.lanes.policy.{PolicyNumbers, TeamPolicies}
import skein.lanes.score.ScoreLanes
import skein.lanes.timetable.Timetable

/** What teams that are simulated side by side have in common.
  *
  * @param efforts by judged number, the vehicle whose effort it is; else it is the next one of the scores
  * @param altitudesDownM of vehicles that fly level
  */
private[lanes] final case class TeamForm(
    policies: TeamPolicies,
    scores: ScoreLanes,
    efforts: Vector[Option[Int]],
    durationS: Double,
    altitudesDownM: Vector[Double]
)(val vehicles: LaneDynamics):
  override val hashCode: Int = MurmurHash3.caseClassHash(this)

  export policies.{count, inSpace}

  /** Whether somebody knows another vehicle by a camera alone. */
  def sees: Boolean = policies.eyes.nonEmpty

/** A candidate with the numbers by which it differs from others of its form.
  *
  * @param lanes its form, or why SIMD does not support it
  * @param stepped the engine that steps its vehicles side by side, if any
  */
private[lanes] final class PreparedTeam(
    val candidate: TeamCandidate,
    lanes: => Either[String, TeamForm],
    stepped: => Option[Engine]
):
  lazy val form: Option[TeamForm] = lanes.toOption
  lazy val isStepped: Boolean     = stepped.isDefined

  val vehicles: Array[RolloutAgent] = candidate.engagement.agents.toArray

  lazy val ofPolicies: Array[PolicyNumbers] = form.toArray.flatMap: form =>
    vehicles.zipWithIndex.map((agent, self) => form.policies.numbersOf(self, agent.policy))

  lazy val ofQuantities: Array[Array[Double]] = form.toArray.flatMap: form =>
    candidate.quantities.toArray.zipWithIndex.map: (each, number) =>
      form.scores.parametersOf(number, each.quantity)

/** The episodes that teams share, under one loop's timing. */
private[lanes] final class Episodes(timing: LoopTiming):
  /** Whether all worlds of teams of a form have one episode: worlds that wait for their controller have no
    * delays.
    */
  def areOne(form: TeamForm): Boolean = timing.isInstanceOf[LoopTiming.Paused] && !form.sees

  /** The key by which an episode differs from others. */
  def nameOf(link: Delays, key: Int, form: TeamForm): Any =
    val delays = if areOne(form) then () else (link, key)
    (delays, form.count, form.durationS, form.policies.needsMore, form.policies.eyes)

  def timetable(link: Delays, key: Int, form: TeamForm): Timetable =
    import form.policies.{eyes, needsMore}
    Timetable.of(form.count, form.durationS, timing, link, key, form.vehicles, eyes, needsMore)
