package skein.search

import skein.forward.{Delays, Engagement}
import skein.lanes.{Accelerator, Engine, TeamBatch, TeamCandidate}
import skein.optimise.*
import skein.policy.SearchSpace
import skein.scenario.{Scenario, Scenarios}

/** A search's question in the user's words: enough to continue it, or to repeat it. */
trait PosedSearch:
  def method: String
  def conditions: Conditions
  def link: String

  /** @return Left says what was expected, what was given, and in which option */
  def setup(using Scenarios): Either[String, ReadySearch]

  /** The words of the question that may be names of files. */
  final def named: Seq[String] = Seq(link, conditions.plant) ++ conditions.eye

/** The varied parameters of a search, and the scenario that they change. */
trait Searched:
  def space: SearchSpace

  def name: String

  /** The searched policies or settings and their opponent, in a line.
    *
    * @param axes the searched parameters
    */
  def subject(axes: String): String

  /** Describes a candidate's parameters for people. */
  def label(candidate: Vector[Double]): String

  def baseline: Baseline

  def scenario(candidate: Vector[Double]): Scenario

  /** The vehicles of forward simulation, with their objective.
    *
    * @param candidate the parameters; those of the baseline if `judge` is the baseline
    * @param by the objective of a candidate with default parameters
    */
  def team(candidate: Vector[Double], judge: Judge, by: Objective): (Engagement, Objective)

  /** Whether all candidates' vehicles have equal speeds and first headings. */
  def isAtOnePace: Boolean = true

  /** Whether an engine is so fast that the scalar reference checks it. */
  def isFast(engine: Engine): Boolean

  /** @param together the candidates' engine
    * @param alone the winner's engine
    */
  def effort(together: Engine, alone: Engine, by: Conditions.Resolved): Effort

  /** Name and contents of a file that holds the result in a form that `./skein fly` accepts. */
  def file(found: Found, of: ReadySearch): (String, String)

/** A search whose question is resolved: processes that resolve equal questions evaluate with identical bits.
  *
  * @param objective the objective of a candidate with default parameters
  * @param fresh number of episodes for the winner, if the user chose one
  * @param accelerator simulates the candidates, if requested
  */
final case class ReadySearch(
    question: PosedSearch,
    searched: Searched,
    objective: Objective,
    flownBy: TeamEngine,
    by: SearchMethod,
    fresh: Option[Int],
    seed: Long,
    accelerator: Option[Accelerator] = None
):
  export flownBy.{isVirtual, model, vehicles}
  export objective.{formula, text, unit}
  export question.{link, method}
  export searched.{baseline, label, name, scenario, space, subject}

  /** The defaults' result on the first episodes, by this process without an accelerator: another program, or
    * another build, is known by it.
    */
  lazy val probe: Vector[RunningStats] =
    acceleratedBy(None).judges(1)(Judge.Candidates).tallies(Vector(space.defaults), ReadySearch.Probes)

  val search: Search =
    val leastPlayOff = if isVirtual then ReadySearch.LeastPlayOff else Search.LeastPlayOff
    Search(space, by, objective.direction, seed, leastPlayOff)

  /** This search with an accelerator that simulates its candidates. */
  def acceleratedBy(accelerator: Option[Accelerator]): ReadySearch = copy(accelerator = accelerator)

  /** Evaluators in this process, for one call at a time. */
  def judges(threads: Int): Judge => ValueEvaluator = flownBy match
    case TeamEngine.Reduced(conditions, delays) =>
      val batch = conditions.batch(threads, accelerator)
      val each  = Judge.values.toVector.map(judge => evaluator(batch, delays, judge, share(judge)))
      judge => each(judge.ordinal)
    case TeamEngine.Whole(flights) =>
      val same = WholeFlightEvaluator(flights, scenario, objective, threads)
      _ => same

  private def evaluator(batch: TeamBatch, delays: Delays, judge: Judge, share: Boolean) =
    TeamEvaluator(batch, team(_, judge), delays, objective, seed, share, space.defaults)

  private def team(candidate: Vector[Double], judge: Judge): TeamCandidate =
    val (flown, own) = searched.team(candidate, judge, objective)
    TeamCandidate(flown, own.judged(durationS, periodMs * 1e-3), searched.isAtOnePace)

  /** A candidate's statistics by the scalar reference; None if that is the engine already, or forward
    * simulation cannot be used.
    */
  def reference(candidate: Vector[Double], episodes: Range): Option[RunningStats] = flownBy match
    case TeamEngine.Reduced(conditions, delays) if searched.isFast(engine(candidate, Judge.Winner)) =>
      val scalar = evaluator(conditions.reference, delays, Judge.Winner, share = false)
      Some(scalar.tallies(Vector(candidate), episodes).head)
    case _ => None

  /** The engine that evaluates a candidate, or the baseline, for `judge`. */
  def engine(candidate: Vector[Double], judge: Judge): Engine = flownBy match
    case TeamEngine.Reduced(_, delays) => asked.engine(team(candidate, judge), share(judge), Seq(delays))
    case TeamEngine.Whole(flights)     => flights.engine

  /** A batch that is only queried for a candidate's engine; for measures of quantities. */
  private lazy val asked: TeamBatch = flownBy match
    case TeamEngine.Reduced(conditions, _) => conditions.batch(1, accelerator)
    case _: TeamEngine.Whole => throw IllegalStateException("whole flights are flown by no batch")

  private def share(judge: Judge) = judge == Judge.Candidates && sharing

  /** Whether candidates share episodes. Making an episode's timetable takes as long as it saves for some
    * hundred candidates, so a few candidates are faster with delays of their own.
    */
  private lazy val sharing: Boolean = flownBy match
    case TeamEngine.Reduced(_, delays) =>
      def alone = asked.engine(team(space.defaults, Judge.Candidates), shareEpisodes = false, Seq(delays))
      accelerator.nonEmpty || by.together(space.dimension) >= ReadySearch.ShareFrom || !alone.isFast
    case _: TeamEngine.Whole => false

  /** Describes the engine of the candidates, and if they differ, those of the winner's fresh episodes and of
    * the baseline.
    */
  def engines: String =
    val together = flown(Judge.Candidates)
    val fresh    = Vector(flown(Judge.Winner), engine(baseline.candidate, Judge.Baseline)).distinct
    together.text + (if fresh == Vector(together) then ""
                     else fresh.mkString("; fresh episodes: ", "; the baseline's: ", ""))

  private def flown(judge: Judge) = engine(space.defaults, judge)

  /** Number of episodes per second, for people, measured by simulating whole flights; None with other
    * engines.
    */
  def rate(threads: Int): Option[String] = flownBy match
    case _: TeamEngine.Reduced     => None
    case TeamEngine.Whole(flights) => Some(flights.rate(scenario(space.defaults), objective, threads))

  /** Whether it uses forward simulation, rather than flights in virtual time. */
  def fliesForward: Boolean = !isVirtual

  def effort: Effort = flownBy match
    case TeamEngine.Reduced(conditions, _) =>
      searched.effort(flown(Judge.Candidates), flown(Judge.Winner), conditions)
    case TeamEngine.Whole(flights) => flights.effort

  /** Number of episodes in a block of work for other processes: about half a second of one core. */
  def blockEpisodes: Int = flownBy match
    case TeamEngine.Reduced(conditions, _) =>
      Effort.blockEpisodes(searched.isFast(flown(Judge.Candidates)), conditions.vehicle)
    case TeamEngine.Whole(flights) => flights.blockEpisodes

  def file(found: Found): (String, String) = searched.file(found, this)

  def loop: String      = question.conditions.loopText
  def durationS: Double = question.conditions.durationS
  def periodMs: Double  = question.conditions.periodMs

  def under: String = s"$loop over $link"

  def title: String = s"$name, $under"

  /** The objective with its unit, for the axis of a picture. */
  def measure: String = objective.title

object ReadySearch:
  private val Probes    = 0 until 4
  private val ShareFrom = 256

  /** Minimum number of episodes in the play-off per candidate when flights are slow. */
  private val LeastPlayOff = 2
