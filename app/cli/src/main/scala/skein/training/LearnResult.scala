package skein.training

import skein.optimise.{Evaluator, RunningStats}
import skein.plot.Drawing
import skein.report.{Section, TextTable}
import skein.scenario.ScenarioText
import skein.search.{Judge, SearchResult}
import skein.settings.PolicyFile
import skein.units.Interval

/** A learned policy, evaluated on episodes that learning did not use.
  *
  * @param paper the baseline on equal episodes
  * @param flights results of flights in virtual time, if there were any: [[LearnGame.came]]
  */
final case class LearnResult(
    setup: LearnSetup,
    state: LearnState,
    policy: PolicyFile,
    fresh: RunningStats,
    paper: RunningStats,
    flights: Option[RunningStats]
):
  import setup.{baseline, game, question}

  /** The results as a table, with the baseline's results. */
  def section: Section =
    def row(policy: String, where: String, tally: RunningStats, unit: String) =
      val interval = Interval.of(tally.mean, tally.halfWidth95)
      Vector(policy, where, interval.mean, interval.half, tally.count.toString, unit)
    val episodes = s"fresh episodes, ${game.formula}"
    val policies = if state.scores.size == 1 then "1 policy" else s"${state.scores.size} policies"
    Section(
      s"Learned by ${question.algorithm} under ${question.conditions.loop} over ${question.link}",
      s"The best of $policies, met after ${state.best.fold(0L)(_.steps)} steps.",
      table = Some(TextTable(
        Vector("<policy", "<where", "mean", "± 95 %", "of", "<unit"),
        Vector(
          row(setup.family.name, episodes, fresh, game.unit),
          row(baseline.name, episodes, paper, game.unit)
        ) ++ flights.map(row(
          setup.family.name,
          s"flights in virtual time, ${game.cameTo.what}",
          _,
          game.cameTo.unit
        ))
      ))
    )

  def curve: Drawing =
    LearningCurve(
      setup.title,
      setup.measure,
      Seq((question.algorithm, LearningCurve.learned, state.scores)),
      Seq((baseline.name, LearningCurve.paper, paper.mean))
    )

  def csv: String =
    state.scores.map(score => s"${score.steps},${score.mean},${score.sd}").mkString(
      "steps,mean,sd\n",
      "\n",
      "\n"
    )

  /** The learned policy as a policy file, with its results. */
  def file: String = LearnResult.file(
    setup,
    state,
    policy,
    SearchResult.objective(game.text, game.unit, fresh, baseline.name, paper)
  )

object LearnResult:
  /** @param by evaluates the learned policy, and the paper's policy as the baseline
    * @param state a state with a best policy
    */
  def measured(setup: LearnSetup, by: Judge => Evaluator, state: LearnState, episodes: Int): LearnResult =
    val policy = setup.policy(state.best.get.weights)
    val range  = SearchResult.FreshFrom until SearchResult.FreshFrom + episodes
    LearnResult(
      setup,
      state,
      policy,
      by(Judge.Winner).tallies(Vector(policy.parameters), range).head,
      by(Judge.Baseline).tallies(Vector(setup.baseline.candidate), range).head,
      None
    )

  /** The best policy so far as a file, without an evaluation. */
  def unmeasured(setup: LearnSetup, state: LearnState): Option[String] =
    state.best.map(best => file(setup, state, setup.policy(best.weights), ""))

  private def file(setup: LearnSetup, state: LearnState, policy: PolicyFile, measured: String): String =
    policy.hocon(
      measured + SearchResult.question(
        "learned",
        setup.question,
        "by"          -> "./skein learn",
        "complete"    -> (state.rounds == setup.rounds),
        "scenario"    -> ScenarioText.called(setup.question.scenario),
        "steps"       -> (state.rounds * setup.stepsOfRound).toDouble,
        "stepsOfBest" -> state.best.fold(0.0)(_.steps.toDouble)
      )
    )
