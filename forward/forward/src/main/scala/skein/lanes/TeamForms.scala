package skein.lanes

import java.util.concurrent.ConcurrentHashMap
import skein.forward.{Engagement, LoopTiming, SpatialResponse, TeamResponses, VelocityResponse}
import skein.lanes.policy.{OpponentLanes, TeamLanes, TeamPolicies}
import skein.lanes.score.{Effort, ScoreLanes}
import skein.units.Expect

/** The forms of teams under one loop's timing, or why SIMD does not support them. Thread-safe.
  *
  * @param isReference whether SIMD is refused for all teams
  */
private[lanes] final class TeamForms(
    timing: LoopTiming,
    model: VelocityResponse,
    isReference: Boolean = false
):
  private val inSpace     = model.body.isInstanceOf[SpatialResponse]
  private val isPredicted = timing.isInstanceOf[LoopTiming.Predictive]

  private val flown: Either[String, LaneDynamics] =
    for
      _        <- LaneSupport.present
      _        <- Expect.that(!isReference)("the reference was asked for")
      vehicles <- LaneDynamics.under(timing, model)
    yield vehicles

  /** Maximum number of other responses: each makes forms, kernels and timetables of its own. */
  private val MostOthers = 16

  /** One object for each other response, so that forms compare it by reference. */
  private val others = ConcurrentHashMap[VelocityResponse, Either[String, LaneDynamics]]()

  /** The dynamics of teams of one model by size: candidates of a search are many. */
  private val alike = ConcurrentHashMap[Int, Vector[LaneDynamics]]()

  private def dynamics(team: Engagement): Either[String, Vector[LaneDynamics]] =
    flown.flatMap: own =>
      if !team.hasCars then Right(alike.computeIfAbsent(team.agents.size, Vector.fill(_)(own)))
      else
        Expect.each(TeamResponses.of(team.agents, model)): response =>
          if response eq model then Right(own)
          else if others.size >= MostOthers && !others.containsKey(response) then
            Left(s"its cars start along more than $MostOthers headings")
          else others.computeIfAbsent(response, LaneDynamics.under(timing, _, inSpace))

  /** One object for each form, so that forms are compared by reference. */
  private val forms = ConcurrentHashMap[TeamForm, TeamForm]()

  def of(candidate: TeamCandidate): Either[String, TeamForm] =
    import candidate.{engagement, quantities}
    val efforts = candidate.judged.map:
      case Effort(vehicle) => Some(vehicle)
      case _               => None
    for
      vehicles <- dynamics(engagement)
      _        <- LaneDynamics.isHighEnough(model, engagement.agents)
      policies <- Option
        .when(candidate.areAtOnePace):
          OpponentLanes.of(engagement, efforts.flatten.contains, inSpace, isPredicted)
        .flatten
        .getOrElse(teamOf(engagement, vehicles, efforts.flatten))
      _ <- Expect.that(engagement.isOver.isEmpty || candidate.ownEnd.isDefined):
        "its end is no scenario's"
      _ <- Expect.that(engagement.isOver.isEmpty || efforts.flatten.isEmpty):
        "SIMD sums efforts only of episodes that last for their whole duration"
      scores <- ScoreLanes
        .of(quantities, engagement.agents.size, candidate.ownEnd)
        .left
        .map(_.getMessage)
    yield
      val altitudes = if inSpace then Vector.empty else engagement.agents.map(_.altitudeDownM)
      val form      = TeamForm(policies, scores, efforts, engagement.durationS, altitudes, vehicles):
        !engagement.hasCars
      val known = forms.putIfAbsent(form, form)
      if known == null then form else known

  private def teamOf(
      engagement: Engagement,
      vehicles: Vector[LaneDynamics],
      efforts: Vector[Int]
  ): Either[String, TeamPolicies] =
    for
      team <- TeamLanes
        .of(engagement.agents.map(_.policy), engagement.assignment, isPredicted, inSpace)
        .left
        .map(refused => s"a policy is no formula: ${refused.getMessage}")
      _ <- Expect.that(efforts.isEmpty):
        "SIMD sums efforts only of two that play against each other by headings"
      _ <- Expect.that(engagement.agents.forall(_.eye.isEmpty)):
        "SIMD supports a sensor only if two play against each other by headings"
      _ <- vehicles.indices.iterator
        .filter(vehicles(_).fliesLevel)
        .flatMap(self => team.leaves(self, engagement.agents(self)))
        .nextOption()
        .toLeft(())
      _ <- Expect.that(!team.looksUp || !model.regardsYaw):
        "a policy asks how high vehicles are, and the quadrotor's height is not told side by side"
      _ <- Expect.that(!team.turns || !model.regardsYaw):
        "a policy may turn its vehicle, and this one keeps its yaw"
    yield team
