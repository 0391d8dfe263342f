package skein.rollout

import skein.policy.SearchSpace
import skein.signal.{NormalQuantile, SplitMix64}

/** A candidate and its objective over so many episodes. */
final case class Scored(candidate: Vector[Double], value: Double, episodes: Int)

/** Chooses the best of many candidates. Pure: equal arguments give equal answers. Small values are good; of equal ones
  * the first wins.
  */
object Search:

  /** Evaluates all candidates on all episodes; best first. */
  def all(objective: Objective, candidates: Vector[Vector[Double]], episodes: Int): Vector[Scored] =
    require(episodes > 0, s"episodes must be positive, got $episodes")
    candidates
      .zip(objective.values(candidates, 0 until episodes))
      .map(Scored(_, _, episodes))
      .sortBy(_.value)

  /** Successive halving (Jamieson, Talwalkar, AISTATS 2016): every candidate flies a few episodes, the better half as
    * many again, and so on, so that hopeless candidates stop early. The survivors' means cover all their episodes.
    *
    * @return
    *   the survivor first, then the others by how far they came, each with what it had flown
    */
  def halving(
      objective: Objective,
      candidates: Vector[Vector[Double]],
      firstEpisodes: Int
  ): Vector[Scored] =
    require(candidates.nonEmpty, "nothing to choose from")

    def race(field: Vector[Scored], out: Vector[Scored]): Vector[Scored] =
      if field.size == 1 then field ++ out
      else
        val (ahead, behind) = field.splitAt((field.size + 1) / 2)
        val flown           = ahead.head.episodes
        val more            = objective.values(ahead.map(_.candidate), flown until 2 * flown)
        val next            = ahead
          .zip(more)
          .map((scored, value) => Scored(scored.candidate, (scored.value + value) / 2, 2 * flown))
        race(next.sortBy(_.value), behind ++ out)

    race(all(objective, candidates, firstEpisodes), Vector.empty)

  /** The cross-entropy method (Rubinstein, Kroese, 2004) with independent normal distributions, cut to the space: each
    * generation is drawn around the elite of the one before. Every generation meets the same episodes.
    *
    * @param elite
    *   share of a generation that makes the next, above 0 to 1
    * @param smoothing
    *   weight of the new mean and spread against the old, above 0 to 1
    * @return
    *   the best candidate seen
    */
  def crossEntropy(
      objective: Objective,
      space: SearchSpace,
      population: Int,
      generations: Int,
      episodes: Int,
      seed: Long,
      elite: Double = 0.2,
      smoothing: Double = 0.8
  ): Scored =
    require(elite > 0 && elite <= 1 && smoothing > 0 && smoothing <= 1, s"elite $elite, smoothing $smoothing")
    val elites = (population * elite).round.toInt.max(2)
    require(population >= elites, s"a population of $population has no elite of $elites")

    def evolve(
        generation: Int,
        means: Vector[Double],
        spreads: Vector[Double],
        best: Option[Scored]
    ): Scored =
      if generation == generations then best.get
      else
        val source     = SplitMix64(SplitMix64.seedOf(seed, generation))
        val candidates = Vector.fill(population):
          space.clamp(means.zip(spreads).map((mean, spread) => mean + spread * normal(source)))
        val ranked      = all(objective, candidates, episodes)
        val chosen      = ranked.take(elites).map(_.candidate)
        val eliteMeans  = means.indices.toVector.map(axis => chosen.map(_(axis)).sum / elites)
        val eliteSpread = means.indices.toVector.map: axis =>
          math.sqrt(chosen.map(c => (c(axis) - eliteMeans(axis)) * (c(axis) - eliteMeans(axis))).sum / elites)
        evolve(
          generation + 1,
          blend(means, eliteMeans, smoothing),
          blend(spreads, eliteSpread, smoothing),
          Some(best.filter(_.value <= ranked.head.value).getOrElse(ranked.head))
        )

    require(generations > 0, s"generations must be positive, got $generations")
    val centre = space.axes.map(axis => (axis.least + axis.most) / 2)
    val spread = space.axes.map(axis => (axis.most - axis.least) / 2)
    evolve(0, centre, spread, None)

  private def normal(source: SplitMix64): Double =
    NormalQuantile(source.nextDouble().max(1e-12).min(1 - 1e-12))

  private def blend(old: Vector[Double], fresh: Vector[Double], weight: Double): Vector[Double] =
    old.zip(fresh).map((o, f) => (1 - weight) * o + weight * f)
