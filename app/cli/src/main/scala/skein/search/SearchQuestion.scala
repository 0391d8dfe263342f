package skein.search

import skein.forward.Delays
import skein.lanes.{Accelerator, DuelBatch, Engine}
import skein.optimise.{
  DuelEvaluator,
  Objective,
  RunningStats,
  Search,
  SearchMethod,
  ValueEvaluator
}
import skein.policy.{HeadingPolicy, PolicyFamily, Role, SearchSpace}
import skein.scenario.Scenarios
import skein.settings.PolicyFile
import skein.units.Expect
import upickle.default.ReadWriter

/** The question of a search for a duel's policy.
  *
  * @param opponent a policy as [[PolicyFile.text]] writes it, of the other role
  * @param candidates approximate number to evaluate
  * @param episodes of each candidate; when racing, in the first round
  * @param population of a generation, for methods that have them
  * @param fresh episodes for the winner; without it, as many as the engine simulates quickly
  */
final case class SearchQuestion(
    family: String,
    role: String,
    objective: String,
    method: String,
    conditions: Conditions,
    link: String,
    opponent: String,
    candidates: Int,
    episodes: Int,
    population: Int,
    seed: Long,
    fresh: Option[Int] = None
) extends PosedSearch derives ReadWriter:

  def setup(using scenarios: Scenarios): Either[String, SearchSetup] =
    for
      family    <- scenarios.family(family).left.map("--family: " + _)
      role      <- PolicyFile.roleOf(family, Some(role)).left.map("--role: " + _)
      objective <- Objective.parse(objective, role).left.map("--objective: " + _)
      flown     <- conditions.resolved
      delays    <- conditions.delays(link, vehicles = 2).left.map("--link: " + _)
      opponent  <- PolicyFile
        .parse(Role.opponentOf(role), opponent)
        .left
        .map("--opponent: " + _)
      _ <- Expect.that(fresh.forall(count => count >= 2 && count <= SearchQuestion.MostEpisode)):
        s"--fresh: expected 2 to ${SearchQuestion.MostEpisode}, came ${fresh.getOrElse(0)}"
      method <- SearchQuestion.method(method, candidates, episodes, population, family.space.dimension)
    yield SearchSetup(this, family, role, objective, flown, delays, opponent, method)

object SearchQuestion:
  val Methods             = "grid, random, cross-entropy, cma-es, racing"
  private val MostRacing  = 100_000
  private val MostEpisode = 1_000_000

  /** @return Left states what was expected, what was given, and in which option */
  def method(
      name: String,
      candidates: Int,
      episodes: Int,
      population: Int,
      dimension: Int
  ): Either[String, SearchMethod] =
    for
      _ <- Expect.that(candidates >= 4)(s"--candidates: expected 4 or more, came $candidates")
      _ <- Expect.that(episodes >= 1 && episodes <= MostEpisode):
        s"--episodes: expected 1 to $MostEpisode, came $episodes"
      _ <- Expect.that(population >= 4 && population <= candidates):
        s"--population: expected 4 to the number of candidates, $candidates, came $population"
      generations = (candidates / population).max(1)
      method <- name match
        case "grid" =>
          val perAxis = math.floor(math.pow(candidates, 1.0 / dimension) + 1e-9).toInt
          Either.cond(
            perAxis >= 2,
            SearchMethod.Grid(perAxis, episodes),
            s"--candidates: a grid over $dimension parameters needs 2^$dimension or more, came $candidates"
          )
        case "random"        => Right(SearchMethod.Random(candidates, episodes))
        case "cross-entropy" => Right(SearchMethod.CrossEntropy(population, generations, episodes))
        case "cma-es"        => Right(SearchMethod.CmaEs(population, generations, episodes))
        case "racing"        =>
          val race = SearchMethod.Racing(candidates, episodes)
          for
            _ <- Expect.that(candidates <= MostRacing):
              s"--candidates: a race takes at most $MostRacing, came $candidates"
            _ <- Expect.that(race.mostOfOne <= Search.PlayOffFrom):
              s"--episodes: the last of $candidates candidates in a race may fly at most " +
                s"${Search.PlayOffFrom} episodes, and came to ${race.mostOfOne}, " +
                s"${race.mostOfOne / episodes} times those of the first round: expected at " +
                s"most ${Search.PlayOffFrom / (race.mostOfOne / episodes)}, came $episodes"
          yield race
        case other => Left(s"--method: expected one of $Methods, came '$other'")
    yield method

/** A search for a duel's policy, ready to run.
  *
  * @param accelerator that simulates the candidates, if requested
  */
final case class SearchSetup(
    question: SearchQuestion,
    family: PolicyFamily,
    role: Role,
    objective: Objective,
    conditions: Conditions.Resolved,
    delays: Delays,
    opponent: PolicyFile,
    by: SearchMethod,
    accelerator: Option[Accelerator] = None
) extends ReadySearch:
  def space: SearchSpace = family.space
  def name: String       = family.name
  def vehicles: String   = conditions.vehicle.description
  def model: String      = conditions.vehicle.name
  def blockEpisodes: Int = Effort.blockEpisodes(flown(Judge.Candidates).isFast, conditions.vehicle)
  def fresh: Option[Int] = question.fresh
  def label(candidate: Vector[Double]): String = policy(candidate).label
  def subject(axes: String): String = s"${question.role} ${family.name} ($axes) against ${opponent.label}"

  def acceleratedBy(accelerator: Option[Accelerator]): SearchSetup = copy(accelerator = accelerator)

  val search: Search = Search(space, by, objective.direction, question.seed)

  private val paper = PolicyFile.paperOf(role)

  val baseline: Baseline = Baseline.of(paper)

  private def policy(candidate: Vector[Double]) = PolicyFile(role, family, candidate)

  def batch(threads: Int): DuelBatch = conditions.batch(threads, accelerator)

  /** @param many whether many candidates will have equal episodes */
  def evaluator(
      batch: DuelBatch,
      of: PolicyFamily = family,
      many: Boolean = true
  ): ValueEvaluator = DuelEvaluator(
    batch,
    durationS,
    of,
    role,
    opponent.policy,
    delays,
    objective,
    question.seed,
    shareEpisodes = many
  )

  def judges(threads: Int): Judge => ValueEvaluator =
    val flown = batch(threads)
    val each  = Judge.values.toVector.map:
      case Judge.Candidates => evaluator(flown, many = sharing)
      case Judge.Winner     => evaluator(flown, many = false)
      case Judge.Baseline   => evaluator(flown, paper.family, many = false)
    judge => each(judge.ordinal)

  def reference(candidate: Vector[Double], episodes: Range): Option[RunningStats] =
    Option.when(flown(Judge.Winner).isFast)(
      evaluator(conditions.reference, many = false).tallies(Vector(candidate), episodes).head
    )

  def effort: Effort =
    Effort.of(flown(Judge.Candidates), flown(Judge.Winner), conditions.vehicle, conditions.sees)

  private def flown(judge: Judge) = engine(space.defaults, judge)

  def engine(candidate: Vector[Double], judge: Judge): Engine =
    val of = if judge == Judge.Baseline then paper.family else family
    engine(of.policy(candidate), judge == Judge.Candidates && sharing)

  private def engine(policy: HeadingPolicy, share: Boolean): Engine =
    val (pursuer, evader) = pair(policy)
    asked.engine(pursuer, evader, share, Seq(delays))

  private lazy val sharing = shares(by, accelerator, engine(family.defaultPolicy, share = false))

  /** Only queried for the engine's name. */
  private lazy val asked = batch(1)

  private def pair(of: HeadingPolicy): (HeadingPolicy, HeadingPolicy) =
    if role == Role.Pursuer then (of, opponent.policy) else (opponent.policy, of)

  /** The found policy as a policy file: its name and its text. */
  def file(found: Found): (String, String) =
    val remarks =
      SearchResult.objective(text, unit, found.fresh, baseline.name, found.baseline) +
        SearchResult.question(
          "found",
          question,
          "by"            -> "./skein search",
          "complete"      -> found.state.isDone,
          "vehicles"      -> conditions.vehicle.description,
          "episodesFlown" -> found.state.flown.toDouble
        )
    "policy.conf" -> policy(found.best).hocon(remarks)
