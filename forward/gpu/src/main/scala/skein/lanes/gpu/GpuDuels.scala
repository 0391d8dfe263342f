package skein.lanes.gpu

import java.util.IdentityHashMap
import scala.collection.mutable
import skein.gpu.Gpu
import skein.lanes.{Accelerated, AcceleratedDuels, DuelEpisodes, DuelNumber, DuelOutcomes, DuelWorlds}
import skein.lanes.policy.PolicyLanes
import skein.policy.HeadingPolicy

/** Simulates duels' candidates on a GPU, each in all episodes, by [[GpuDuelKernel]]. Mutable; one call at a
  * time.
  *
  * @param threads that make timetables and read policies
  */
private[lanes] final class GpuDuels(
    gpu: Gpu,
    episodes: DuelEpisodes,
    vehicle: GpuVehicle.Kind,
    prediction: Option[GpuPrediction.Kind],
    threads: Int
) extends AcceleratedDuels:
  import GpuDuels.*

  private val onGpu   = GpuEpisodes(gpu, vehicles = 2, shows = false, threads, GpuParts.MostBytes)
  private val kernels =
    mutable.HashMap.empty[(Vector[PolicyLanes], Set[DuelNumber], GpuLayout), GpuDuelKernel]

  def fly(
      worlds: DuelWorlds,
      captureRadiusM: Float,
      into: DuelOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Accelerated =
    val each       = worlds.episodesOfEach
    val candidates = GpuEpisodes.candidatesOf(worlds)
    val sides      = Vector(
      Side(candidates, threads, candidate => worlds.evader(candidate * each)),
      Side(candidates, threads, candidate => worlds.pursuer(candidate * each))
    )
    val (known, unknown) =
      Array.range(0, candidates).partition(candidate => sides.forall(_.formOf(candidate) != null))
    val flown = GpuParts(known, each, onProgress, isCancelled)
      .fly(
        candidate => sides.map(_.formOf(candidate)),
        _ => 2 * episodes.duel.durationS / episodes.timing.periodS
      ): (forms, some, numbers) =>
        val names   = numbers.toVector.map(i => episodes.of(worlds.link(i), worlds.key(i)))
        val brought = onGpu.bring(names, isCancelled): i =>
          episodes.timetable(worlds.link(numbers(i)), worlds.key(numbers(i)))
        brought.map(fly(worlds, forms, some, numbers, sides, _, captureRadiusM, into)).isDefined
    Accelerated(flown, GpuEpisodes.worldsOf(unknown, each))

  private def fly(
      worlds: DuelWorlds,
      forms: Vector[PolicyLanes],
      some: Array[Int],
      numbers: Array[Int],
      sides: Vector[Side],
      flown: Vector[GpuEpisodes.Held],
      captureRadiusM: Float,
      into: DuelOutcomes
  ): Unit =
    val kernel = kernels.getOrElseUpdate(
      (forms, worlds.asked, onGpu.layout),
      GpuDuelKernel(
        gpu,
        episodes.duel,
        episodes.timing.periodS,
        vehicle,
        prediction,
        forms,
        worlds.asked,
        onGpu.layout
      )
    )
    val flownBy = Vector(0, 1).map(side => sides(side).numbersOf(some)(kernel.numbersOf(side, _)))
    val came    = kernel.fly(flown, some.length, flownBy, captureRadiusM)
    for number <- worlds.asked; (episode, at) <- flown.zipWithIndex do
      val (place, tell) = kernel.outcome(number, episode.scoredAtS)
      val told          = into(number)
      val first         = (place * flown.size + at) * some.length
      var candidate     = 0
      while candidate < some.length do
        told(some(candidate) * worlds.episodesOfEach + numbers(at)) = tell(came(first + candidate))
        candidate += 1

private object GpuDuels:
  /** Number of candidates whose policies a thread reads in one piece of work. */
  private val Chunk = 256

  /** The policies of one side of many candidates. */
  private final class Side(candidates: Int, threads: Int, of: Int => HeadingPolicy):
    private val policies = Array.tabulate(candidates)(of)
    private val forms    = Array.ofDim[PolicyLanes](candidates)
    // Nearly always all of one side are the very same.
    GpuEpisodes.inParallel(candidates, Chunk, threads): i =>
      forms(i) =
        if i % Chunk > 0 && (policies(i) eq policies(i - 1)) then forms(i - 1)
        else PolicyLanes.of(policies(i)).getOrElse(null)

    /** Form of a candidate's policy; null if it is not a formula. */
    def formOf(candidate: Int): PolicyLanes = forms(candidate)

    /** The distinct numbers of these candidates' policies, and the index of each candidate's. */
    def numbersOf(some: Array[Int])(read: HeadingPolicy => Array[Float]): (Array[Float], Array[Int]) =
      val known    = IdentityHashMap[HeadingPolicy, Integer]()
      val used     = mutable.ArrayBuffer.empty[HeadingPolicy]
      val numberOf = some.map: candidate =>
        val policy = policies(candidate)
        val number = known.putIfAbsent(policy, used.size)
        if number != null then number.intValue
        else
          used += policy
          used.size - 1
      val numbers = Array.ofDim[Array[Float]](used.size)
      GpuEpisodes.inParallel(used.size, Chunk, threads)(i => numbers(i) = read(used(i)))
      (numbers.flatten, numberOf)
