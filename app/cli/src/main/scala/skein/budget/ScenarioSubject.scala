package skein.budget

import java.util.concurrent.atomic.AtomicLong
import skein.flight.InParallel
import skein.forward.*
import skein.lanes.Engine
import skein.loop.LoopKind
import skein.optimise.{Objective, RunningStats, ScenarioTerm}
import skein.scenario.{Scenario, Scenarios}
import skein.search.{Conditions, Effort, WholeFlights}
import skein.signal.{LatencyDistribution, LatencyProfile}

/** A budget's question about a scenario: the sum of its measures, under a loop. */
final case class ScenarioQuestion(
    scenario: Scenario,
    objective: Objective,
    conditions: Conditions,
    seed: Long,
    threads: Int
):

  /** Chooses the engine: forward simulation, with SIMD or world by world, where it supports the policies and
    * measures, else flights in virtual time.
    *
    * @return Left says what was expected, what was given, and in which option
    */
  def subject(plantIsTold: Boolean)(using Scenarios): Either[String, BudgetSubject] =
    WholeFlights.engagement(scenario, conditions.durationS) match
      case Left(reason) if plantIsTold => Left(WholeFlights.noPlant(reason))
      case Left(reason)                => conditions.checked.map(FlownSubject.virtual(this, _, reason))
      case Right(engagement)           =>
        for
          plant <-
            WholeFlights.plant(engagement, WholeFlights.climbs(engagement), conditions.plant, plantIsTold)
          flown <- conditions
            .copy(plant = plant, altitudeM = Conditions.altitudeM(scenario))
            .resolved
        yield WholeFlights
          .whole(engagement, objective)
          .fold(team(engagement, flown))(FlownSubject.forward(this, flown, _))

  private def team(engagement: Engagement, flown: Conditions.Resolved) = TeamSubject(
    conditions,
    flown,
    scenario.title,
    engagement,
    engagement,
    objective,
    Effort.ofTeam,
    seed,
    threads
  )

object ScenarioQuestion:

  /** @param objective a sum of measures by their keys; by default the first */
  def of(
      scenario: Scenario,
      objective: Option[String],
      conditions: Conditions,
      seed: Long,
      threads: Int
  ): Either[String, ScenarioQuestion] =
    for
      first <- scenario.measures.headOption.toRight(
        s"--scenario: expected one with measures; ${scenario.name} has none"
      )
      asked <- Objective
        .ofScenario(objective.getOrElse(ScenarioTerm.keyOf(first)), scenario)
        .left
        .map("--objective: " + _)
    yield ScenarioQuestion(scenario, asked, conditions, seed, threads)

/** A scenario with any measures, which are evaluated on whole flights.
  *
  * @param over episodes over a link with these round trips; None: in a world that stands still while the
  *   controller decides
  */
final class FlownSubject private (
    question: ScenarioQuestion,
    over: Option[LatencyDistribution] => WholeFlights
) extends BudgetSubject(BudgetTask(
      question.conditions.loopText,
      question.conditions.periodMs,
      question.conditions.durationS,
      over(None).vehicles,
      question.scenario.title,
      question.objective.formula,
      question.objective.unit
    )):

  def engine(links: Vector[LatencyDistribution]): Engine = over(None).engine

  def cellEpisodes(links: Vector[LatencyDistribution]): Int = over(None).effort.cellEpisodes

  def truth(episodes: Int): Either[String, Double] =
    val each             = question.conditions.pausedEpisodes(episodes)
    val (missing, flown) = InParallel
      .map(Vector.range(0, each), question.threads)(value(None, _).map(_.getOrElse(Double.NaN)))
      .partitionMap(identity)
    missing.headOption.toLeft(RunningStats.of(each)(flown).mean)

  private def value(link: Option[LatencyDistribution], episode: Int): Either[String, Option[Double]] =
    over(link).sum(question.scenario, question.objective, episode)

  def tallies(cells: BudgetCells): Either[String, Vector[RunningStats]] =
    val done = AtomicLong()
    val all  = cells.links.flatMap(link => Vector.tabulate(cells.episodes)((link, _)))
    val came = InParallel.map(all, question.threads): (link, episode) =>
      if cells.isCancelled() then Left(BudgetSubject.Stopped)
      else
        val came = value(Some(link), episode).map(_.getOrElse(Objective.Never))
        cells.onProgress(done.incrementAndGet())
        came
    val (missing, flown) = came.partitionMap(identity)
    missing.headOption.toLeft(
      flown.grouped(cells.episodes).map(values => RunningStats.of(values.size)(values)).toVector
    )

object FlownSubject:

  /** Simulates flights forward, world by world.
    *
    * @param why no faster engine can be used
    */
  def forward(question: ScenarioQuestion, flown: Conditions.Resolved, why: String): FlownSubject =
    FlownSubject(
      question,
      link =>
        WholeFlights.scalar(
          if link.isEmpty then flown.paused else flown,
          link.fold(DelayTable.none)(DelayTable.of),
          question.seed,
          why
        )
    )

  /** Runs flights in virtual time, with the actual simulator, link, client and loop. */
  def virtual(question: ScenarioQuestion, loop: LoopKind, reason: String): FlownSubject =
    FlownSubject(
      question,
      link =>
        WholeFlights.virtual(
          question.conditions,
          if link.isEmpty then LoopKind.Paused else loop,
          link.fold(LatencyProfile.none)(LatencyProfile.Steady("cell", _)),
          question.seed,
          reason
        )
    )
