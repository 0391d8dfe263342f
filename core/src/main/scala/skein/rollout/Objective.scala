package skein.rollout

/** What a search makes small. All candidates meet the same episodes (common random numbers), so that their differences
  * are their own.
  */
trait Objective:

  /** The mean over these episodes for each candidate. A pure function: the same arguments give the same bits.
    *
    * @param episodes
    *   numbers of the episodes, at least one
    */
  def values(candidates: Vector[Vector[Double]], episodes: Range): Vector[Double]

/** The mean distance of the last 10 s, m, that the paper's pursuer keeps with a given turn rate (the only parameter,
  * rad/s), by [[StreamDuelKernel]].
  *
  * @param seed
  *   of the delays
  * @param threads
  *   worlds are shared out among as many; the caller waits for them. The result does not depend on it.
  */
final class TurnRateObjective(
    duel: Duel,
    timing: LoopTiming.Stream,
    link: DelayTable,
    model: Reduced,
    evaderRadiusM: Double = 8.0,
    seed: Long = 1,
    threads: Int = 1
) extends Objective:
  require(threads > 0, s"threads must be positive, got $threads")

  private val kernels = Vector.fill(threads)(StreamDuelKernel(duel, timing, link, model))

  def values(candidates: Vector[Vector[Double]], episodes: Range): Vector[Double] =
    val turnRates = candidates.map(_.head.toFloat).toArray
    val worlds    = candidates.size * episodes.size
    val distances = Array.ofDim[Float](worlds)
    val batches   = (worlds + StreamDuelKernel.WORLDS - 1) / StreamDuelKernel.WORLDS
    val workers   = kernels.zipWithIndex.map: (kernel, worker) =>
      Thread: () =>
        for batch <- worker until batches by threads do fly(kernel, batch, turnRates, episodes, distances)
    workers.foreach(_.start())
    workers.foreach(_.join())
    Vector.tabulate(candidates.size): candidate =>
      var sum = 0.0
      for episode <- 0 until episodes.size do sum += distances(candidate * episodes.size + episode)
      sum / episodes.size

  /** Worlds that no candidate needs fly the last one again. */
  private def fly(
      kernel: StreamDuelKernel,
      batch: Int,
      turnRates: Array[Float],
      episodes: Range,
      distances: Array[Float]
  ): Unit =
    val first = batch * StreamDuelKernel.WORLDS
    val pairs = Array.tabulate(StreamDuelKernel.WORLDS)(i => (first + i).min(distances.length - 1))
    // The candidate does not enter the key: all meet the same delays.
    val keys = pairs.map(pair => WorldRandom.key(seed, 0, episodes(pair % episodes.size)))
    kernel.fly(
      keys,
      pairs.map(pair => turnRates(pair / episodes.size)),
      Array.fill(pairs.length)(evaderRadiusM.toFloat)
    )
    for i <- pairs.indices if first + i < distances.length do distances(first + i) = kernel.meanLast10s(i)
