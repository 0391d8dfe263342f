package skein.environment

import scala.util.Try
import skein.forward.{Delays, Engagement, LoopTiming, VelocityResponse}
import skein.lanes.{Engine, LearnerPolicy, LearnerTeams, TeamCandidate}
import skein.lanes.score.{Judged, OfMoment}
import skein.optimise.Objective
import skein.policy.{Policy, Role}
import skein.scenario.{Measure, Reduction, Scenario, Scenarios}
import skein.settings.{PolicyFile, ScenarioSettings, VehicleChoice}
import skein.simd.LaneMath
import skein.units.Expect
import skein.vehicle.{ReducedModel, VehicleKind}

/** Resolved settings: the vehicles that learn, their team, and their rewards.
  *
  * @param engagement all vehicles, with their policies if they do not learn
  * @param turns indices of an environment's learners; the next environment has the next entry
  * @param objectives objective of each vehicle; if None, a small or a great distance to the nearest opponent
  *   is rewarded
  */
private[environment] final case class LearnerSide(
    settings: EnvironmentSettings,
    names: Vector[String],
    engagement: Engagement,
    turns: Vector[Vector[Int]],
    objectives: Option[Vector[Objective]],
    timing: LoopTiming,
    link: Delays,
    response: VelocityResponse
):
  /** Makes worlds that SIMD simulates. */
  val maker: LearnerTeams.Maker = LearnerTeams.Maker(timing, link, response)

  def learners: Int = turns.head.size

  def roleOf(vehicle: Int): Role = engagement.roles(vehicle)

  /** Whether a capture is a learner's gain or its loss. */
  def captureSign(vehicle: Int): Int = if roleOf(vehicle) == Role.Pursuer then 1 else -1

  /** The opponents of a vehicle, of which the nearest counts. */
  def rivals(vehicle: Int): Vector[Int] = engagement.assignment.rivals(vehicle)

  /** Whether a learner turns by a rate, and the maximum turn: rad/s, or rad. */
  def mostTurn(vehicle: Int): (Boolean, Float) =
    val (rate, angle) = settings.mostTurn(roleOf(vehicle))
    if rate > 0 then (true, rate.toFloat) else (false, angle.toFloat)

  /** An environment's vehicles with its learners. Its scores are, for each learner that is [[apart]], the
    * newest and the minimum distance to its nearest opponent, and then the costs.
    *
    * @param beside policy of the other vehicles of a learner's role; if None, their own
    */
  def team(learning: Vector[Int], beside: Option[Policy]): TeamCandidate =
    val agents = engagement.agents.zipWithIndex.map: (agent, place) =>
      if learning.contains(place) then agent.copy(policy = LearnerPolicy(mostTurn(place)._1, settings.space))
      else if roleOf(place) == roleOf(learning.head) then
        beside.fold(agent)(policy => agent.copy(policy = policy))
      else agent
    val distances = apart(learning).map: learner =>
      Nearest(learner, rivals(learner).toArray, settings.space.climbs)
    val costs = objectives match
      case None      => distances.map(Judged(_, Reduction.Mean, 0))
      case Some(all) =>
        all.head.measures.flatMap(_._2.reduced).map(each => Judged(each.quantity, each.reduction, 0))
    TeamCandidate(
      engagement.copy(agents = agents),
      distances.flatMap(each => Vector(Judged(each, OfMoment.Newest, 0), Judged(each, Reduction.Least, 0))) ++
        costs
    )

  /** The learners whose distances to their opponents may differ; with two vehicles, the first one.
    */
  def apart(learning: Vector[Int]): Vector[Int] =
    if engagement.agents.size == 2 then learning.take(1) else learning

  /** The weights of what costs a learner: of values, or of squares where their root mean square is optimised.
    *
    * @param place index among the learners
    */
  def weights(learning: Vector[Int], place: Int): Array[Float] = objectives match
    case Some(all) =>
      val by = all(learning(place))
      by.measures
        .map: (weight, measure) =>
          val scale = if LearnerSide.isRms(measure) then EnvironmentSettings.RewardM else 1f
          (by.direction.sign * weight).toFloat / scale
        .toArray
    case None =>
      val sign  = Objective.naturally(roleOf(learning(place))).sign.toFloat
      val those = apart(learning)
      those.indices.map(each => if each == place.min(those.size - 1) then sign else 0f).toArray

  /** The engine that simulates the environments.
    *
    * @param beside see [[team]]
    */
  def engine(beside: Option[Policy]): Engine =
    turns.iterator.flatMap(each => maker.refusal(team(each, beside))).nextOption() match
      case None      => Engine(Engine.Kind.Lanes, s"SIMD, ${LaneMath.LANES} environments at a time")
      case Some(why) => Engine.scalar(why)

private[environment] object LearnerSide:

  /** @param against policy of the vehicles of another role; if None, the one that the settings name
    * @return Left says what was expected and what was given
    */
  def of(settings: EnvironmentSettings, against: Option[PolicyFile] = None)(using
      scenarios: Scenarios
  ): Either[String, LearnerSide] =
    for
      // Every program knows Skein's scenarios.
      kind <- scenarios
        .kind(settings.scenario)
        .left.flatMap(why => Scenarios.ours.kinds.find(_.name == settings.scenario).toRight(why))
        .left.map("scenario: " + _)
      scenario <- ScenarioSettings.ofKeys(kind, settings.set).left.map("set: " + _)
      agents = scenario.agents
      turns <- settings.turns(agents)
      _     <- refusal(scenario, turns.flatten).map(why =>
        s"scenario: expected one of vehicles that know where others are, got ${scenario.name}, $why"
      ).toLeft(())
      opponent <- against.fold(settings.opponentOf(agents(turns.head.head).role))(file => Right(Some(file)))
      isFree = (place: Int) => !turns.flatten.contains(place)
      _ <- Expect.that(opponent.forall(file =>
        agents.indices.exists(place => isFree(place) && agents(place).role == file.role)
      )):
        s"opponent: expected none where no ${opponent.get.role} flies without a learner, got '${settings.opponent}'"
      flown <- Try(Engagement.ofScenario(scenario, settings.episodeS + EnvironmentSettings.SpareS)).toEither
        .left.map("scenario: " + _.getMessage)
      engagement = flown.copy(agents = flown.agents.zipWithIndex.map: (agent, place) =>
        val by = opponent.filter(file => isFree(place) && agents(place).role == file.role)
        agent.copy(
          altitudeDownM =
            if settings.altitudeM != 0 && agent.kind == VehicleKind.Multirotor then -settings.altitudeM
            else agent.altitudeDownM,
          policy = by.fold(agent.policy)(_.policy)
        ))
      objectives <-
        if settings.objective.isEmpty then Right(None) else objectivesOf(settings, scenario).map(Some(_))
      altitudeM = -engagement.agents(turns.head.head).altitudeDownM
      climbs    =
        if settings.space.climbs then Some("learners climb (climb_mps)") else climbing(engagement, turns)
      resolved <-
        settings.flown(altitudeM, climbs.fold(levelAt(altitudeM))(_ => VehicleChoice.Tilt), agents.size)
      (timing, delays, vehicle) = resolved
      _ <- Expect.that(climbs.isEmpty || vehicle.response.isSpatial):
        s"plant: expected ${VehicleChoice.Tilt} or ${VehicleChoice.Spatial}, got ${vehicle.name}: ${climbs.get}"
    yield LearnerSide(
      settings,
      agents.map(_.name),
      engagement,
      turns,
      objectives,
      timing,
      delays,
      vehicle.response
    )

  private def levelAt(altitudeM: Double) =
    if altitudeM == ReducedModel.IdentifiedAtM then "reduced" else "drag"

  /** The reason why some vehicle without a learner may leave its altitude; None if all keep it. */
  private def climbing(engagement: Engagement, turns: Vector[Vector[Int]]): Option[String] =
    val learning = turns.flatten
    val level    = engagement.agents.zipWithIndex.map: (agent, place) =>
      if turns.size == 1 && learning.contains(place) then agent.copy(policy = LearnerPolicy(byRate = true))
      else agent
    engagement.copy(agents = level).climbs

  private def objectivesOf(
      settings: EnvironmentSettings,
      scenario: Scenario
  ): Either[String, Vector[Objective]] =
    for
      all <- Expect
        .each(scenario.agents.map(_.role)): role =>
          Objective.ofQuantities(settings.objective, scenario, Objective.naturally(role))
        .left
        .map("objective: " + _)
      measures = all.head.measures.map(_._2)
      _ <- measures.find(!EnvironmentSettings.rewards(_))
        .orElse(measures.find(_ => measures.sizeIs > 1 && measures.exists(isRms)))
        .map: _ =>
          "objective: expected means over time, or one root mean square alone: " +
            s"rewards add up to these, got ${all.head.formula}"
        .toLeft(())
    yield all

  private def isRms(measure: Measure) = measure.reduced.exists(_.reduction == Reduction.Rms)

  private def refusal(scenario: Scenario, learners: Vector[Int]): Option[String] =
    if learners.exists(scenario.agents(_).kind != VehicleKind.Multirotor) then
      Some("in which a car would learn")
    else if scenario.eyes.nonEmpty || scenario.equipment.nonEmpty then Some("which sees by cameras or lidars")
    else Option.when(scenario.agents.sizeIs < 2)("of one vehicle")
