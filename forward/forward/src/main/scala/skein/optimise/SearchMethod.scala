package skein.optimise

/** How a [[Search]] chooses its candidates. In all cases `episodes` is the number of episodes per candidate.
  */
enum SearchMethod:
  /** Candidates on an even grid that includes both bounds of every axis. */
  case Grid(perAxis: Int, episodes: Int)

  case Random(candidates: Int, episodes: Int)

  /** The cross-entropy method (Rubinstein, Kroese, 2004) with independent normal distributions, clipped to
    * the space. Each generation is drawn from a distribution fitted to the elite of the previous one.
    *
    * @param elite share of a generation to which the next is fitted, above 0 up to 1
    * @param smoothing weight of the new mean and deviation against the old ones, above 0 up to 1
    */
  case CrossEntropy(
      population: Int,
      generations: Int,
      episodes: Int,
      elite: Double = 0.2,
      smoothing: Double = 0.8
  )

  /** [[skein.optimise.CmaEs]] on the space, scaled to the unit cube and mirrored at its bounds; it starts at
    * the defaults. It ends early when its spread is below 10^−6^ of every axis.
    */
  case CmaEs(population: Int, generations: Int, episodes: Int, startSize: Double = 0.3)

  /** Successive halving (Jamieson, Talwalkar, AISTATS 2016): random candidates run a few episodes, the better
    * half runs as many again, and so on until one is left. So poor candidates stop early.
    *
    * @param episodes number of episodes in the first round; the last candidate runs about `candidates` times
    *   as many
    */
  case Racing(candidates: Int, episodes: Int)

  def episodes: Int

  /** Number of candidates per round; when racing, in the first round. */
  def together(dimension: Int): Long = this match
    case CrossEntropy(population, _, _, _, _) => population
    case CmaEs(population, _, _, _)           => population
    case Racing(candidates, _)                => candidates
    case _: (Grid | Random)                   => evaluations(dimension) / episodes

  /** The largest number of episodes that one candidate runs. */
  def mostOfOne: Long = this match
    case Racing(candidates, episodes) =>
      Math.multiplyExact(episodes.toLong, 1L << (SearchMethod.rounds(candidates) - 1))
    case _ => episodes

  /** Total number of episodes of all candidates, unless the search ends early. */
  def evaluations(dimension: Int): Long = this match
    case Grid(perAxis, episodes) =>
      (1 to dimension).foldLeft(episodes.toLong)((product, _) => Math.multiplyExact(product, perAxis.toLong))
    case Random(candidates, episodes)                          => candidates.toLong * episodes
    case CrossEntropy(population, generations, episodes, _, _) => population.toLong * generations * episodes
    case CmaEs(population, generations, episodes, _)           => population.toLong * generations * episodes
    case Racing(candidates, episodes)                          =>
      Iterator
        .iterate((candidates, episodes.toLong, 0L)): (field, each, round) =>
          ((field + 1) / 2, if round == 0 then each else 2 * each, round + 1)
        .take(SearchMethod.rounds(candidates))
        .map((field, each, _) => field * each)
        .sum

object SearchMethod:
  /** Number of rounds of a race, until one candidate is left. */
  private[skein] def rounds(candidates: Int): Int =
    Iterator.iterate(candidates)(field => (field + 1) / 2).takeWhile(_ > 1).size + 1
