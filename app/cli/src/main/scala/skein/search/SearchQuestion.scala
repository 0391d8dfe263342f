package skein.search

import skein.forward.Engagement
import skein.lanes.Engine
import skein.optimise.{Objective, Search, SearchMethod}
import skein.pickle.Fields
import skein.policy.{PolicyFamily, Role}
import skein.scenario.{Scenario, Scenarios}
import skein.settings.PolicyFile
import skein.units.Expect

/** The question of a search for a duel's policy.
  *
  * @param opponent a policy as [[PolicyFile.text]] writes it, of the other role
  * @param candidates approximate number of candidates to evaluate
  * @param episodes number of episodes for each candidate; when racing, in the first round
  * @param population number of candidates in a generation, for methods that have them
  * @param fresh number of episodes for the winner; without it, as many as the engine simulates quickly
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
) extends PosedSearch derives Fields:

  def setup(using scenarios: Scenarios): Either[String, ReadySearch] =
    for
      family    <- scenarios.family(family).left.map("--family: " + _)
      role      <- PolicyFile.roleOf(family, Some(role)).left.map("--role: " + _)
      objective <- Objective.ofRole(objective, role).left.map("--objective: " + _)
      flown     <- conditions.resolved
      delays    <- flown.delays(link, vehicles = 2).left.map("--link: " + _)
      opponent  <- PolicyFile
        .parse(Role.opponentOf(role), opponent)
        .left
        .map("--opponent: " + _)
      _      <- Expect.optional(fresh)(Expect.within("--fresh", _, 2, SearchQuestion.MostEpisode))
      method <- SearchQuestion.method(method, candidates, episodes, population, family.space.dimension)
    yield
      val searched = SearchedFamily(this, family, role, flown.game, opponent)
      ReadySearch(this, searched, objective, TeamEngine.Reduced(flown, delays), method, fresh, seed)

object SearchQuestion:
  val Methods = "grid, random, cross-entropy, cma-es, racing"

  /** The methods that make candidates by generations. */
  val WithPopulation = Set("cma-es", "cross-entropy")

  private val MostRacing  = 100_000
  private val MostEpisode = 1_000_000

  /** @return Left says what was expected, what was given, and in which option */
  def method(
      name: String,
      candidates: Int,
      episodes: Int,
      population: Int,
      dimension: Int
  ): Either[String, SearchMethod] =
    for
      _ <- Expect.that(candidates >= 4)(s"--candidates: expected 4 or more, got $candidates")
      _ <- Expect.within("--episodes", episodes, 1, MostEpisode)
      _ <- Expect.that(population >= 4 && population <= candidates):
        s"--population: expected 4 to the number of candidates, $candidates, got $population"
      generations = (candidates / population).max(1)
      method <- name match
        case "grid" =>
          val perAxis = math.floor(math.pow(candidates, 1.0 / dimension) + 1e-9).toInt
          Either.cond(
            perAxis >= 2,
            SearchMethod.Grid(perAxis, episodes),
            s"--candidates: a grid over $dimension parameters needs 2^$dimension or more, got $candidates"
          )
        case "random"        => Right(SearchMethod.Random(candidates, episodes))
        case "cross-entropy" => Right(SearchMethod.CrossEntropy(population, generations, episodes))
        case "cma-es"        => Right(SearchMethod.CmaEs(population, generations, episodes))
        case "racing"        =>
          val race = SearchMethod.Racing(candidates, episodes)
          for
            _ <- Expect.that(candidates <= MostRacing):
              s"--candidates: a race takes at most $MostRacing, got $candidates"
            _ <- Expect.that(race.mostOfOne <= Search.PlayOffFrom):
              s"--episodes: the last of $candidates candidates in a race may fly at most " +
                s"${Search.PlayOffFrom} episodes, and came to ${race.mostOfOne}, " +
                s"${race.mostOfOne / episodes} times those of the first round: expected at " +
                s"most ${Search.PlayOffFrom / (race.mostOfOne / episodes)}, got $episodes"
          yield race
        case other => Left(s"--method: expected one of $Methods, got '$other'")
    yield method

/** A family's policies for one role, against an opponent.
  *
  * @param game the game in which they are evaluated
  */
private final class SearchedFamily(
    question: SearchQuestion,
    family: PolicyFamily,
    role: Role,
    game: Engagement,
    opponent: PolicyFile
) extends Searched:
  private val paper = PolicyFile.paperOf(role)
  private val pair  = game.flownBy(opponent.role, opponent.policy)

  export family.{name, space}
  val baseline: Baseline                       = Baseline.of(paper)
  def label(candidate: Vector[Double]): String = policy(candidate).label
  def subject(axes: String): String   = s"${question.role} ${family.name} ($axes) against ${opponent.label}"
  def isFast(engine: Engine): Boolean = engine.isFast

  def scenario(candidate: Vector[Double]): Scenario =
    throw UnsupportedOperationException("a policy of a family flies by forward simulation")

  def team(candidate: Vector[Double], judge: Judge, by: Objective): (Engagement, Objective) =
    (pair.flownBy(role, (if judge == Judge.Baseline then paper.family else family).policy(candidate)), by)

  def effort(together: Engine, alone: Engine, by: Conditions.Resolved): Effort =
    Effort.of(together, alone, by.vehicle, by.sees)

  private def policy(candidate: Vector[Double]) = PolicyFile(role, family, candidate)

  /** Name and text of a policy file with the found policy. */
  def file(found: Found, of: ReadySearch): (String, String) =
    val remarks =
      SearchResult.objective(of.text, of.unit, found.fresh, baseline.name, found.baseline) +
        SearchResult.question(
          "found",
          question,
          "by"            -> "./skein search",
          "complete"      -> found.state.isDone,
          "vehicles"      -> of.vehicles,
          "episodesFlown" -> found.state.flown.toDouble
        )
    "policy.conf" -> policy(found.best).hocon(remarks)
