package skein.training

import skein.optimise.{Evaluator, RunningStats}
import skein.plot.Drawing
import skein.report.{Section, TextTable}
import skein.search.{Judge, SearchResult}
import skein.settings.PolicyFile
import skein.units.Decimals.significant

/** What was learned, measured on episodes that learning never met.
  *
  * @param paper
  *   the paper's policy of the same side on the same episodes
  * @param flights
  *   mean distances of the last 10 s of flights in virtual time, m, where such were flown
  */
final case class LearnResult(
    setup: LearnSetup,
    state: LearnState,
    policy: PolicyFile,
    fresh: RunningStats,
    paper: RunningStats,
    flights: Option[RunningStats]
):
  import setup.{objective, question}

  /** As a table. */
  def section: Section =
    def row(policy: String, where: String, tally: RunningStats, unit: String) =
      Vector(
        policy,
        where,
        tally.mean.significant(4),
        tally.halfWidth95.significant(4),
        tally.count.toString,
        unit
      )
    val episodes = s"fresh episodes, ${objective.formula}"
    Section(
      s"Learned by ${question.algorithm} under ${question.conditions.loop} over ${question.link}",
      s"The best of ${state.scores.size} policies, met after ${state.best.fold(0L)(_.steps)} steps.",
      table = Some(TextTable(
        Vector("<policy", "<where", "mean", "± 95 %", "of", "<unit"),
        Vector(
          row(setup.family.name, episodes, fresh, objective.unit),
          row(setup.paper.family.name, episodes, paper, objective.unit)
        ) ++ flights.map(row(setup.family.name, "flights in virtual time, last 10 s", _, "m"))
      ))
    )

  def curve: Drawing =
    LearningCurve(
      setup.title,
      setup.measure,
      Seq((question.algorithm, LearningCurve.learned, state.scores)),
      Seq((setup.paper.family.name, LearningCurve.paper, paper.mean))
    )

  def csv: String =
    state.scores.map(score => s"${score.steps},${score.mean},${score.sd}").mkString(
      "steps,mean,sd\n",
      "\n",
      "\n"
    )

  /** As a policy file. */
  def file: String = policy.hocon(
    SearchResult.objective(objective.text, objective.unit, fresh, setup.paper.family.name, paper) +
      s"""learned {
       |  by = "./skein learn"
       |  complete = ${state.rounds == setup.rounds}
       |  algorithm = ${question.algorithm}
       |  loop = ${question.conditions.loop}
       |  periodMs = ${question.conditions.periodMs}
       |  link = "${question.link}"
       |  plant = "${question.conditions.plant}"
       |  opponent = "${question.opponent}"
       |  altitudeM = ${question.conditions.altitudeM}
       |  steps = ${state.rounds * setup.stepsOfRound}
       |  stepsOfBest = ${state.best.fold(0L)(_.steps)}
       |  seed = ${question.seed}
       |}
       |""".stripMargin
  )

object LearnResult:
  /** @param by
    *   judges what was learned, and the paper's policy as the baseline
    * @param state
    *   with a best policy
    */
  def measured(setup: LearnSetup, by: Judge => Evaluator, state: LearnState, episodes: Int): LearnResult =
    val policy = setup.policy(state.best.get.weights)
    val range  = SearchResult.FreshFrom until SearchResult.FreshFrom + episodes
    LearnResult(
      setup,
      state,
      policy,
      by(Judge.Winner).tallies(Vector(policy.parameters), range).head,
      by(Judge.Baseline).tallies(Vector(setup.paper.parameters), range).head,
      None
    )
