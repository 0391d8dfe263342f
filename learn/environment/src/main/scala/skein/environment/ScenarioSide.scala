package skein.environment

import scala.util.Try
import skein.forward.{Delays, Engagement, LoopTiming, Rollout, VelocityResponse}
import skein.optimise.{Objective, ScenarioTerm}
import skein.policy.{Agent, Fleet, PaperPursuer, Policy, Role}
import skein.scenario.{Positions, Quantity, Reduction, Scenario, Scenarios}
import skein.settings.ScenarioSettings
import skein.signal.SplitMix64
import skein.units.{Expect, OwnFailure}
import skein.vehicle.VehicleKind

/** A side of a scenario that learns: the caller decides for one vehicle of its role; the others of the role
  * use a policy set by the caller, all other vehicles their own policies.
  *
  * @param members of the role, by their indices in the scenario
  * @param objective that is rewarded; without one, a small or a great distance to the nearest opponent
  */
private[environment] final case class ScenarioSide(
    settings: EnvironmentSettings,
    scenario: Scenario,
    role: Role,
    members: Vector[Int],
    objective: Option[Objective],
    timing: LoopTiming,
    link: Delays,
    response: VelocityResponse
):
  private val agents = scenario.agents
  private val rivals = agents.indices.filter(agents(_).role != role).toArray
  private val downM  = IArray.from(agents.map(_.startPositionNed.z))

  def count: Int = agents.size

  def nameOf(vehicle: Int): String = agents(vehicle).name

  /** The vehicles of an episode, with their policies.
    *
    * @param learner its index
    * @param beside policy of the others of its role; without one, their own
    * @param seed of the initial positions
    */
  def engagement(learner: Int, policy: Policy, beside: Option[Policy], seed: Long): Engagement =
    val random = SplitMix64(seed)
    val flown  = agents.zipWithIndex.map: (agent, place) =>
      val (least, most)    = settings.startWithinM
      val (moved, bearing) = (least + random.nextDouble() * (most - least), 2 * math.Pi * random.nextDouble())
      val chosen: Policy   =
        if place == learner then policy
        else if agent.role == role then beside.getOrElse(agent.policy)
        else agent.policy
      agent.copy(
        policy = chosen,
        startPositionNed = agent.startPositionNed.copy(
          x = agent.startPositionNed.x + moved * StrictMath.cos(bearing),
          y = agent.startPositionNed.y + moved * StrictMath.sin(bearing)
        )
      )
    Engagement.of(Fleet(flown), settings.episodeS + EnvironmentSettings.SpareS)

  /** Distance from the learner to its nearest opponent, m. */
  def distanceM(learner: Int, northM: Array[Double], eastM: Array[Double]): Double =
    var least = Double.PositiveInfinity
    for rival <- rivals do
      least = least.min(StrictMath.hypot(northM(rival) - northM(learner), eastM(rival) - eastM(learner)))
    least

  /** The learner's cost at a score, in the reward's unit. */
  def loss(distanceM: Double, northM: Array[Double], eastM: Array[Double]): Double = objective match
    case None     => if role == Role.Pursuer then distanceM else -distanceM
    case Some(by) =>
      val places = Positions(IArray.from(northM), IArray.from(eastM), downM)
      var sum    = 0.0
      for (weight, measure) <- by.measures; reduced <- measure.reduced do
        val paid = Quantity.told(reduced.quantity, places)
        if !paid.isFinite then
          throw OwnFailure(
            Quantity.whose(reduced.quantity),
            s"answered $paid, which nobody can be rewarded by"
          )
        sum += weight * paid
      by.direction.sign * sum

private[environment] object ScenarioSide:

  /** @return the side that the settings name; Left states what was expected and what was given */
  def of(settings: EnvironmentSettings)(using scenarios: Scenarios): Either[String, ScenarioSide] =
    for
      learners <- settings.roles
      role     <- Either.cond(
        learners.size == 1,
        learners.head,
        "learners: expected pursuer or evader, came 'both', which is the duel's"
      )
      _ <- Expect.that(settings.opponent.isEmpty):
        s"opponent: expected none with scenario ${settings.scenario}, whose " +
          s"others fly their own policies, came '${settings.opponent}'"
      kind     <- scenarios.kind(settings.scenario).left.map("scenario: " + _)
      scenario <- ScenarioSettings.ofKeys(kind, settings.set).left.map("set: " + _)
      agents = scenario.agents
      _ <- refusal(scenario).map(why =>
        s"scenario: expected one of multirotors that are told of one another, came ${scenario.name}, $why"
      ).toLeft(())
      members = agents.indices.filter(agents(_).role == role).toVector
      _ <- Expect.that(members.nonEmpty && members.size < agents.size):
        s"scenario: expected one with a ${role.name.toLowerCase(java.util.Locale.ROOT)} " +
          s"and vehicles of another role, came ${scenario.name} of ${roles(agents)}"
      objective <-
        if settings.objective.isEmpty then Right(None)
        else
          Objective.ofQuantities(
            settings.objective,
            scenario,
            Objective.naturally(role)
          ).left.map("objective: " + _).map(Some(_))
      _ <- objective.toVector.flatMap(_.measures.map(_._2)).find(measure =>
        !isSummed(measure.reduced.get.reduction)
      ).map: measure =>
        "objective: expected means over time, which can be rewarded " +
          s"as they come, came ${ScenarioTerm.keyOf(measure)}"
      .toLeft(())
      // Teams fly low, where the model of three parameters is not valid.
      flown <- settings.flown(-agents(members.head).startPositionNed.z, "drag", agents.size)
      (timing, delays, vehicle) = flown
      side = ScenarioSide(settings, scenario, role, members, objective, timing, delays, vehicle.response)
      _ <- Try(Rollout(
        side.engagement(members.head, PaperPursuer(), None, 0),
        timing,
        delays,
        vehicle.response
      )).toEither.left.map("scenario: " + _.getMessage)
    yield side

  private def isSummed(reduction: Reduction) = reduction == Reduction.Mean || reduction == Reduction.Rms

  private def roles(agents: Vector[Agent]) =
    agents.map(_.role.name.toLowerCase(java.util.Locale.ROOT)).distinct.mkString(" and ")

  private def refusal(scenario: Scenario): Option[String] =
    if scenario.agents.exists(_.kind != VehicleKind.Multirotor) then Some("which has cars")
    else if scenario.eyes.nonEmpty || scenario.equipment.nonEmpty then Some("which sees by cameras or lidars")
    else None
