package skein.lanes

import skein.forward.{Delays, LoopTiming, RolloutAgent}
import skein.lanes.policy.{TeamPolicies, VehicleNumbers}
import skein.lanes.score.ScoreLanes
import skein.lanes.timetable.Timetable

/** The common properties of teams that are simulated together.
  *
  * @param efforts the vehicle whose effort each judged value is; None if the value is the next of `scores`
  * @param altitudesDownM altitudes of vehicles that fly level
  * @param vehicles the dynamics of each vehicle, compared by reference
  * @param byOneModel whether all vehicles move according to the batch's model
  */
private[lanes] final case class TeamForm(
    policies: TeamPolicies,
    scores: ScoreLanes,
    efforts: Vector[Option[Int]],
    durationS: Double,
    altitudesDownM: Vector[Double],
    vehicles: Vector[LaneDynamics]
)(byOneModel: Boolean):
  // Without the vehicles, in which forms hardly ever differ alone.
  override val hashCode: Int = (policies, scores, efforts, durationS, altitudesDownM).hashCode

  export policies.{count, inSpace}

  /** Whether some vehicle knows its opponent only through a camera. */
  def sees: Boolean = policies.eyes.nonEmpty

  val isSensed: Boolean = vehicles.exists(_.sensors.isDefined)

  /** The reason why a GPU does not support such a team; None if it does. */
  def refusedByGpu: Option[String] = policies.refusedByGpu
    .orElse(Option.when(scores.hasEnd)("the GPU flies every episode to its duration"))
    .orElse(Option.unless(byOneModel)("the GPU flies vehicles of one model"))

  lazy val hasParameters: Boolean = (0 until scores.formulas).exists(scores.parameters(_) > 0)

  private lazy val last = Array.ofDim[(RolloutAgent, VehicleNumbers)](policies.count)

  /** The vehicle's start and policy values; the previous object if the agent is the identical object. */
  def numbersOf(self: Int, agent: RolloutAgent): VehicleNumbers =
    val known = last(self)
    if known != null && (known._1 eq agent) then known._2
    else
      val numbers = VehicleNumbers(agent, policies.numbersOf(self, agent.policy))
      last(self) = (agent, numbers)
      numbers

/** A candidate with the values that distinguish it from others of its form.
  *
  * @param lanes its form, or why SIMD does not support the candidate
  * @param stepped the engine that steps its vehicles together, if any
  */
private[lanes] final class PreparedTeam(
    val candidate: TeamCandidate,
    lanes: => Either[String, TeamForm],
    stepped: => Option[Engine]
):
  /** The candidate's form; null if SIMD does not support its policies or quantities. */
  lazy val form: TeamForm     = lanes.getOrElse(null)
  lazy val isStepped: Boolean = stepped.isDefined

  def vehicles: Vector[RolloutAgent] = candidate.engagement.agents

  /** The values of each vehicle; requires a [[form]]. */
  lazy val numbers: Array[VehicleNumbers] =
    Array.tabulate(form.count)(self => form.numbersOf(self, vehicles(self)))

  /** The parameters of each quantity, then of an end; requires a [[form]]. */
  lazy val ofScores: Array[Array[Double]] =
    form.scores.parametersOf(candidate.quantities, candidate.ownEnd)

/** The episodes that teams share under one loop. */
private[lanes] final class Episodes(timing: LoopTiming):
  /** Whether all worlds of a form have one episode, because they wait for their controller and so have no
    * delays. Errors of readings may differ; none is missing.
    */
  def areOne(form: TeamForm): Boolean = timing.isInstanceOf[LoopTiming.Paused] && !form.sees

  /** Everything that distinguishes an episode from other episodes, as a key. */
  def nameOf(link: Delays, key: Int, form: TeamForm): Any =
    val delays = if areOne(form) then () else (link, key)
    (delays, form.vehicles, form.durationS, form.policies.needsMore, form.policies.eyes, form.scores.endsBy)

  /** @param sensorSeed see [[skein.lanes.timetable.Timetable.of]] */
  def timetable(link: Delays, key: Int, form: TeamForm, sensorSeed: Option[Long] = None): Timetable =
    import form.policies.{eyes, needsMore}
    import form.scores.endsBy
    Timetable.of(form.vehicles, form.durationS, timing, link, key, eyes, needsMore, endsBy, sensorSeed)
