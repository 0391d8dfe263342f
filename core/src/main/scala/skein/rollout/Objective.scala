package skein.rollout

import skein.policy.{PaperEvader, PaperPursuer}

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
  * rad/s), by [[DuelBatch]].
  *
  * @param seed
  *   of the delays
  */
final class TurnRateObjective(
    duel: Duel,
    timing: LoopTiming,
    delays: DelayTable,
    model: VelocityResponse,
    evaderRadiusM: Double = 8.0,
    seed: Long = 1,
    threads: Int = 1
) extends Objective:
  private val batch = DuelBatch(duel, timing, model, threads)

  def values(candidates: Vector[Vector[Double]], episodes: Range): Vector[Double] =
    val perCandidate = episodes.size
    val outcomes     = batch.fly(new DuelWorlds:
      def size: Int = candidates.size * perCandidate
      // The candidate does not enter the key: all meet the same delays.
      def key(world: Int): Int              = WorldRandom.key(seed, 0, episodes(world % perCandidate))
      def link(world: Int): DelayTable      = delays
      def pursuer(world: Int): PaperPursuer = PaperPursuer(candidates(world / perCandidate).head)
      def evader(world: Int): PaperEvader   = PaperEvader(evaderRadiusM))
    Vector.tabulate(candidates.size): candidate =>
      var sum = 0.0
      for episode <- 0 until perCandidate do
        sum += outcomes.meanLast10sM(candidate * perCandidate + episode)
      sum / perCandidate
