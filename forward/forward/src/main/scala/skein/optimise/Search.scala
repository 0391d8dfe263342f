package skein.optimise

import skein.policy.SearchSpace
import skein.signal.{NormalQuantile, SplitMix64}

/** A candidate with the tally of its objective values. */
final case class Scored(candidate: Vector[Double], tally: RunningStats)

/** The state of a search, which can be stored and resumed.
  *
  * @param results tallies of the round's candidates so far, in their order
  * @param leaders the best candidates so far, the best first; at the end the standings of the play-off
  * @param flown number of episodes simulated so far
  */
final case class SearchState(
    course: MethodState,
    results: Vector[RunningStats],
    leaders: Vector[Scored],
    flown: Long
):
  def isDone: Boolean      = course == MethodState.Ended
  def best: Option[Scored] = leaders.headOption

/** The state of a search method between rounds. */
enum MethodState:
  /** Grid and random search: index of the round's first candidate. */
  case Listed(next: Long)

  /** Cross-entropy: the distribution from which the next generation is drawn. */
  case Drawn(generation: Int, means: Vector[Double], deviations: Vector[Double])

  case Adapted(state: CmaEs.State)

  /** Racing: the remaining candidates with their tallies; empty before the first round. */
  case Raced(round: Int, field: Vector[Scored])

  /** The play-off on fresh episodes between the leaders, the centre of the distribution and the defaults:
    * number of its episodes so far, and the tallies of the remaining candidates.
    */
  case PlayOff(episodes: Int, field: Vector[Scored])

  case Ended

/** Finds the best of many candidates. All candidates are evaluated on equal episodes. The leaders are
  * compared again on fresh episodes, because the best of many on a few episodes was partly lucky: in each
  * round of this play-off all remaining candidates run more episodes, and the worse half is out, until two
  * have run the last.
  *
  * [[step]] is a pure function, so a search that was stopped and resumed ends like one that ran through. Of
  * equal candidates the first wins.
  *
  * @param seed seed of the random candidates
  * @param leastPlayOff minimum number of episodes in the play-off per candidate that enters it
  */
final class Search(
    space: SearchSpace,
    method: SearchMethod,
    val direction: Direction,
    seed: Long,
    leastPlayOff: Int = Search.LeastPlayOff
):
  import Search.*

  require(
    method.mostOfOne <= PlayOffFrom,
    s"one candidate would fly ${method.mostOfOne} episodes, expected at most $PlayOffFrom"
  )

  private val evolution = method match
    case SearchMethod.CmaEs(population, _, _, _) => Some(CmaEs(space.dimension, population, seed))
    case _                                       => None

  /** Number of episodes in each round of the play-off, of all its candidates together. */
  private val playOffRound =
    val each =
      (method.evaluations(space.dimension) / 5 / PlayOffFields.head).max(leastPlayOff).min(MostPlayOff)
    each.toInt * PlayOffFields.head / PlayOffFields.size

  private def inPlayOff(field: Int): Int = (playOffRound / field).max(1)

  /** Maximum number of episodes of the whole search. */
  val expected: Long =
    method.evaluations(space.dimension) + PlayOffFields.map(_.max(playOffRound).toLong).sum

  def start: SearchState =
    val course = method match
      case _: (SearchMethod.Grid | SearchMethod.Random) => MethodState.Listed(0)
      case _: SearchMethod.CrossEntropy                 =>
        MethodState.Drawn(
          0,
          space.axes.map(axis => (axis.least + axis.most) / 2),
          space.axes.map(_.width / 2)
        )
      case cma: SearchMethod.CmaEs =>
        MethodState.Adapted(evolution.get.start(space.shares(space.defaults), cma.startSize))
      case _: SearchMethod.Racing => MethodState.Raced(0, Vector.empty)
    SearchState(course, Vector.empty, Vector.empty, 0)

  /** Advances the search by one step.
    *
    * @param state the state of a search that is not done
    * @param atMost approximate maximum number of episodes in the step; exceeded if candidates are simulated
    *   together. The division into steps has no effect on the result.
    * @param isCancelled polled repeatedly, from any thread; a cancelled step leaves the state unchanged
    */
  def step(
      state: SearchState,
      evaluator: Evaluator,
      atMost: Int,
      isCancelled: () => Boolean = () => false
  ): SearchState =
    require(!state.isDone, "the search is done")
    val (candidates, episodes) = round(state.course)
    val batch                  = candidates.slice(
      state.results.size,
      state.results.size + (atMost / episodes.size).max(evaluator.sideBySide)
    )
    evaluator.talliesUnless(isCancelled)(batch, episodes).fold(state): tallies =>
      val results = state.results ++ tallies
      val flown   = state.flown + batch.size.toLong * episodes.size
      if results.size < candidates.size then state.copy(results = results, flown = flown)
      else
        val (course, leaders) =
          after(state.course, state.leaders, candidates.zip(results).map(Scored(_, _)))
        SearchState(course, Vector.empty, leaders, flown)

  /** The candidates of the round, and the episodes on which each is evaluated. */
  private def round(course: MethodState): (Vector[Vector[Double]], Range) = course match
    case MethodState.Listed(next) =>
      val numbers = Vector.range(next, (next + MostListed).min(listed))
      val fields  = method match
        case SearchMethod.Grid(perAxis, _) => numbers.map(space.gridAt(perAxis, _))
        case _                             => numbers.map(space.randomAt(seed, _))
      (fields, 0 until method.episodes)
    case MethodState.Drawn(generation, means, deviations) =>
      (drawn(generation, means, deviations), 0 until method.episodes)
    case MethodState.Adapted(state) => (evolution.get.sample(state).map(space.at), 0 until method.episodes)
    case MethodState.Raced(0, _)    => (randomField, 0 until method.episodes)
    case MethodState.Raced(round, field) =>
      val flown = field.head.tally.count
      (field.map(_.candidate), flown until 2 * flown)
    case MethodState.PlayOff(episodes, field) =>
      (
        field.map(_.candidate),
        PlayOffFrom + episodes until PlayOffFrom + episodes + inPlayOff(field.size)
      )
    case MethodState.Ended => throw IllegalStateException("no round after the end")

  private def listed: Long = method match
    case SearchMethod.Grid(perAxis, _)      => space.gridSize(perAxis)
    case SearchMethod.Random(candidates, _) => candidates.toLong
    case _                                  => 0

  private def randomField: Vector[Vector[Double]] = method match
    case SearchMethod.Racing(candidates, _) => space.random(candidates, seed)
    case _                                  => Vector.empty

  private def after(
      course: MethodState,
      before: Vector[Scored],
      seen: Vector[Scored]
  ): (MethodState, Vector[Scored]) =
    lazy val leaders = ranked(before ++ seen).distinctBy(scored => place(scored.candidate)).take(MostLeaders)
    (course, method) match
      case (MethodState.Listed(next), _) =>
        val behind = next + seen.size
        (if behind < listed then MethodState.Listed(behind) else playOff(leaders, None), leaders)
      case (MethodState.Drawn(generation, means, deviations), entropy: SearchMethod.CrossEntropy) =>
        val elites        = eliteOf(entropy)
        val chosen        = ranked(seen).take(elites).map(_.candidate)
        val newMeans      = means.indices.toVector.map(axis => chosen.map(_(axis)).sum / elites)
        val newDeviations = means.indices.toVector.map: axis =>
          math.sqrt(chosen.map(c => (c(axis) - newMeans(axis)) * (c(axis) - newMeans(axis))).sum / elites)
        val (nextMeans, nextDeviations) =
          (blend(means, newMeans, entropy.smoothing), blend(deviations, newDeviations, entropy.smoothing))
        val next =
          if generation + 1 < entropy.generations then
            MethodState.Drawn(generation + 1, nextMeans, nextDeviations)
          else playOff(leaders, Some(space.clamp(nextMeans)))
        (next, leaders)
      case (MethodState.Adapted(state), cma: SearchMethod.CmaEs) =>
        val next = evolution.get.next(state, evolution.get.sample(state), seen.map(cost))
        val goOn = next.generation < cma.generations && next.spread > LeastSpread
        (if goOn then MethodState.Adapted(next) else playOff(leaders, Some(space.at(next.mean))), leaders)
      case (MethodState.Raced(round, field), _) =>
        val standing =
          ranked(if round == 0 then seen
          else field.zip(seen).map((f, s) => f.copy(tally = f.tally + s.tally)))
        val ahead = (standing ++ before).distinctBy(scored => place(scored.candidate)).take(MostLeaders)
        val next  =
          if standing.size == 1 then playOff(ahead, None)
          else MethodState.Raced(round + 1, standing.take((standing.size + 1) / 2))
        (next, ahead)
      case (MethodState.PlayOff(episodes, field), _) =>
        val standing = ranked(field.zip(seen).map((f, s) => f.copy(tally = f.tally + s.tally)))
        val out      = if episodes == 0 then Vector.empty else before.drop(field.size)
        val next     =
          if field.size <= PlayOffFields.last then MethodState.Ended
          else
            MethodState.PlayOff(episodes + seen.head.tally.count, standing.take((field.size + 1) / 2))
        (next, standing ++ out)
      case _ => (MethodState.Ended, before)

  /** The grid cell of a candidate. Of the candidates in one cell, only the best can be a leader: candidates
    * that differ by less than a hundredth of every axis share their luck on the episodes, and would leave no
    * room for other candidates.
    */
  private def place(candidate: Vector[Double]): Vector[Long] =
    space.shares(candidate).map(share => (share * 100).round)

  private def playOff(leaders: Vector[Scored], centre: Option[Vector[Double]]): MethodState =
    val candidates = (leaders.map(_.candidate) ++ centre :+ space.defaults).distinct
    MethodState.PlayOff(0, candidates.map(Scored(_, RunningStats.empty)))

  /** The cost to minimise; NaN counts as the worst. */
  private def cost(scored: Scored): Double =
    val cost = direction.sign * scored.tally.mean
    if cost.isNaN then Double.PositiveInfinity else cost

  private def ranked(all: Vector[Scored]): Vector[Scored] = all.sortBy(cost)

  private def drawn(
      generation: Int,
      means: Vector[Double],
      deviations: Vector[Double]
  ): Vector[Vector[Double]] =
    val population = method match
      case entropy: SearchMethod.CrossEntropy => entropy.population
      case _                                  => 0
    val source = SplitMix64(SplitMix64.seedOf(seed, generation))
    Vector.fill(population):
      space.clamp(means.zip(deviations).map: (mean, deviation) =>
        mean + deviation * NormalQuantile(source.nextDouble().max(1e-12).min(1 - 1e-12)))

object Search:
  /** Number of candidates in the play-off, in addition to the distribution's centre and the defaults. */
  val MostLeaders = 16

  /** First episode of the play-off; all other episodes of a search are below it. */
  val PlayOffFrom: Int = 1 << 24

  /** Number of candidates in each round of the play-off. */
  private val PlayOffFields =
    Vector.iterate(MostLeaders + 2, SearchMethod.rounds(MostLeaders + 2) - 1)(field => (field + 1) / 2)

  // The play-off has a fifth of the search's episodes, within these bounds per candidate that enters it.
  val LeastPlayOff        = 64
  private val MostPlayOff = 1024L

  private val MostListed  = 16384
  private val LeastSpread = 1e-6

  /** Runs a search to its end.
    *
    * @return the standings of the play-off, the best first
    */
  def run(
      space: SearchSpace,
      method: SearchMethod,
      direction: Direction,
      seed: Long,
      evaluator: Evaluator
  ): Vector[Scored] =
    val search = Search(space, method, direction, seed)
    Iterator
      .iterate(search.start)(search.step(_, evaluator, Int.MaxValue))
      .find(_.isDone)
      .get
      .leaders

  private def eliteOf(entropy: SearchMethod.CrossEntropy): Int =
    (entropy.population * entropy.elite).round.toInt.max(2).min(entropy.population)

  private def blend(old: Vector[Double], fresh: Vector[Double], weight: Double): Vector[Double] =
    old.zip(fresh).map((o, f) => (1 - weight) * o + weight * f)
