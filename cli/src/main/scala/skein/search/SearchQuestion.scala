package skein.search

import skein.forward.Delays
import skein.lanes.DuelBatch
import skein.optimise.{DuelEvaluator, Objective, Search, SearchMethod, ValueEvaluator}
import skein.policy.{Policy, PolicyFamily, Role, SearchSpace}
import skein.settings.PolicyFile
import upickle.default.ReadWriter

/** What a search is asked, in the words of the user; enough to go on with it, or to ask again.
  *
  * @param opponent
  *   a policy as [[PolicyFile.text]] writes it, of the other role
  * @param candidates
  *   to be tried in all, about
  * @param episodes
  *   that each flies; when racing, in the first round
  * @param population
  *   of a generation, for the methods that have them
  * @param fresh
  *   episodes on which the winner is measured; without it, as many as the engine flies quickly
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
) derives ReadWriter:

  /** @return or what was expected, what came, and in which option */
  def setup: Either[String, SearchSetup] =
    for
      family    <- PolicyFamily.parse(family).left.map("--family: " + _)
      role      <- PolicyFile.roleOf(family, Some(role)).left.map("--role: " + _)
      objective <- Objective.parse(objective, role).left.map("--objective: " + _)
      flown     <- conditions.resolved
      delays    <- Conditions.delays(link).left.map("--link: " + _)
      opponent  <- PolicyFile
        .parse(if role == Role.Pursuer then Role.Evader else Role.Pursuer, opponent)
        .left
        .map("--opponent: " + _)
      _ <- Either.cond(
        fresh.forall(count => count >= 2 && count <= SearchQuestion.MostEpisode),
        (),
        s"--fresh: expected 2 to ${SearchQuestion.MostEpisode}, came ${fresh.getOrElse(0)}"
      )
      method <- SearchQuestion.method(method, candidates, episodes, population, family.space.dimension)
    yield SearchSetup(this, family, role, objective, flown, delays, opponent, method)

object SearchQuestion:
  val Methods             = "grid, random, cross-entropy, cma-es, racing"
  private val MostRacing  = 100_000
  private val MostEpisode = 1_000_000

  /** The paper's policy of the other role. */
  def paperOpponent(role: Role): PolicyFile =
    if role == Role.Pursuer then PolicyFile.ofDefaults(Role.Evader, PolicyFamily.paperEvader)
    else PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.paperPursuer)

  /** @return or what was expected, what came, and in which option */
  def method(
      name: String,
      candidates: Int,
      episodes: Int,
      population: Int,
      dimension: Int
  ): Either[String, SearchMethod] =
    for
      _ <- Either.cond(candidates >= 4, (), s"--candidates: expected 4 or more, came $candidates")
      _ <- Either.cond(
        episodes >= 1 && episodes <= MostEpisode,
        (),
        s"--episodes: expected 1 to $MostEpisode, came $episodes"
      )
      _ <- Either.cond(
        population >= 4 && population <= candidates,
        (),
        s"--population: expected 4 to the number of candidates, $candidates, came $population"
      )
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
            _ <- Either.cond(
              candidates <= MostRacing,
              (),
              s"--candidates: a race takes at most $MostRacing, came $candidates"
            )
            _ <- Either.cond(
              race.mostOfOne <= Search.PlayOffFrom,
              (),
              s"--episodes: the last of $candidates candidates in a race may fly at most ${Search.PlayOffFrom} episodes, " +
                s"and came to ${race.mostOfOne}, ${race.mostOfOne / episodes} times those of the first round: " +
                s"expected at most ${Search.PlayOffFrom / (race.mostOfOne / episodes)}, came $episodes"
            )
          yield race
        case other => Left(s"--method: expected one of $Methods, came '$other'")
    yield method

/** A search ready to run. */
final case class SearchSetup(
    question: SearchQuestion,
    family: PolicyFamily,
    role: Role,
    objective: Objective,
    conditions: Conditions.Resolved,
    delays: Delays,
    opponent: PolicyFile,
    method: SearchMethod
) extends ReadySearch:
  def space: SearchSpace = family.space

  val search: Search = Search(family.space, method, objective.direction, question.seed)

  /** The paper's policy of the role, which every result is held against. */
  val paper: PolicyFamily =
    if role == Role.Pursuer then PolicyFamily.paperPursuer else PolicyFamily.paperEvader

  def batch(threads: Int): DuelBatch = conditions.batch(threads)

  /** @param many
    *   whether many candidates will meet the same episodes
    */
  def evaluator(
      batch: DuelBatch,
      of: PolicyFamily = family,
      many: Boolean = true
  ): ValueEvaluator = DuelEvaluator(
    batch,
    conditions.duel.durationS,
    of,
    role,
    opponent.policy,
    delays,
    objective,
    question.seed,
    shareEpisodes = many
  )

  def judges(threads: Int): Judge => ValueEvaluator = judges(batch(threads))

  def judges(batch: DuelBatch): Judge => ValueEvaluator =
    val each = Judge.values.toVector.map:
      case Judge.Candidates => evaluator(batch)
      case Judge.Winner     => evaluator(batch, many = false)
      case Judge.Paper      => evaluator(batch, paper, many = false)
    judge => each(judge.ordinal)

  /** Whether this family's policies fly by lanes.
    *
    * @param many
    *   whether many candidates will meet the same episodes
    */
  def isFast(batch: DuelBatch, many: Boolean = true): Boolean =
    val (pursuer, evader) = pair
    batch.fliesByLanes(pursuer, evader, shareEpisodes = many, Seq(delays))

  /** A line that says what flies the candidates. */
  def engine(batch: DuelBatch): String =
    val (pursuer, evader) = pair
    batch.engine(pursuer, evader, shareEpisodes = true, Seq(delays))

  private def pair: (Policy, Policy) =
    if role == Role.Pursuer then (family.defaultPolicy, opponent.policy)
    else (opponent.policy, family.defaultPolicy)
