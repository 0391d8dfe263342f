package skein.lanes

import java.util.IdentityHashMap
import scala.collection.mutable
import skein.forward.Duelist
import skein.gpu.{Gpu, GpuBuffer, Ptx}
import skein.policy.Policy

/** Flies candidates that share episodes on a GPU, by [[GpuDuelKernel]]. The operations of an episode stay
  * there from call to call. Mutable; one call at a time.
  *
  * @param threads that make timetables
  */
private[lanes] final class GpuDuels(
    gpu: Gpu,
    episodes: DuelEpisodes,
    vehicle: (Ptx, Duelist) => GpuVehicle,
    threads: Int
):
  import GpuDuelKernel.{BlockWords, BlockWorlds, Forms}
  import GpuDuels.*

  private var layout  = GpuLayout(2, readings = 4, headings = 4)
  private val held    = java.util.LinkedHashMap[Any, Held](16, 0.75f, true)
  private var bytes   = 0L
  private val kernels = mutable.HashMap.empty[(Forms, Set[DuelNumber], GpuLayout), GpuDuelKernel]

  /** An episode's operations on the GPU. */
  private final class Held(timetable: GpuTimetable):
    val buffer: GpuBuffer       = gpu.buffer(timetable.words)
    val bytes: Long             = 4L * timetable.words.length
    val size: Int               = timetable.size
    val stride: Int             = timetable.stride
    val scoredAtS: Array[Float] = timetable.scoredAtS

  /** Flies all worlds, unless it is cancelled.
    *
    * @param worlds with [[DuelWorlds.episodesOfEach]]
    * @return how many worlds were flown, if all policies are formulas
    */
  def fly(
      worlds: DuelWorlds,
      captureRadiusM: Float,
      into: DuelOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Option[Int] =
    val each       = worlds.episodesOfEach
    val candidates = worlds.size / each
    val sides      = Vector(
      Policies(candidates, threads, candidate => worlds.evader(candidate * each)),
      Policies(candidates, threads, candidate => worlds.pursuer(candidate * each))
    )
    Option.when(sides.forall(_.areFormulas)):
      var done = 0
      for
        alike <-
          Array.range(0, candidates).groupBy(candidate => sides.map(_.formOf(candidate))).valuesIterator
        some <- alike.grouped((MostWorlds / each).max(1))
        part <- Array.range(0, each).grouped(mostEpisodes)
        if !isCancelled() && prepare(part, worlds, isCancelled)
      do
        fly(Part(worlds, some, part, sides), captureRadiusM, into)
        done += some.length * part.length
        onProgress(done)
      done

  private def mostEpisodes = (MostMinutes * 60 / episodes.duel.durationS).toInt.max(1)

  private def episodeOf(worlds: DuelWorlds, number: Int) =
    episodes.of(worlds.link(number), worlds.key(number))

  /** Brings episodes to the GPU.
    *
    * @return whether they are there: not if it was cancelled
    */
  private def prepare(some: Array[Int], worlds: DuelWorlds, isCancelled: () => Boolean): Boolean =
    // Whoever is used now is forgotten last.
    val missing =
      some.filter(number => held.get(episodeOf(worlds, number)) == null).distinctBy(episodeOf(worlds, _))
    val made  = Array.ofDim[Timetable](missing.length)
    val ready = inParallel(missing.length, 1, threads, isCancelled): i =>
      made(i) = episodes.timetable(worlds.link(missing(i)), worlds.key(missing(i)))
    if ready < missing.length then false
    else
      val needed = made.foldLeft(layout)(_.holding(_))
      if needed != layout then
        layout = needed
        forget(most = 0)
        prepare(some, worlds, isCancelled)
      else
        forget(most = MostBytes)
        for (number, timetable) <- missing.zip(made) do
          val now = Held(GpuTimetable(timetable, layout))
          held.put(episodeOf(worlds, number), now): Unit
          bytes += now.bytes
        true

  /** Those used least lately, until no more than so many bytes are held. */
  private def forget(most: Long): Unit =
    val eldest = held.values.iterator
    while bytes > most && eldest.hasNext do
      val old = eldest.next()
      bytes -= old.bytes
      old.buffer.close()
      eldest.remove()

  /** Candidates of one form, and episodes through which each flies: an episode's worlds are neighbours on the
    * GPU.
    */
  private final class Part(
      val worlds: DuelWorlds,
      val candidates: Array[Int],
      numbers: Array[Int],
      sides: Vector[Policies]
  ):
    val forms: Forms           = Forms(sides(0).formOf(candidates(0)), sides(1).formOf(candidates(0)))
    val episodes: Vector[Held] = numbers.iterator.map(number => held.get(episodeOf(worlds, number))).toVector
    def size: Int              = candidates.length * numbers.length
    val flownBy: Vector[FlownBy] = sides.map(_.of(candidates))

    /** Of the first candidate in one of the episodes. */
    def worldOf(candidate: Int, episode: Int): Int =
      candidates(candidate) * worlds.episodesOfEach + numbers(episode)

    /** See [[GpuDuelKernel.apply]]. */
    def blocks: Array[Int] =
      for
        (episode, number) <- episodes.toArray.zipWithIndex
        first             <- candidates.indices by BlockWorlds
        address = episode.buffer.address
        count   = BlockWorlds.min(candidates.length - first)
        word <- Array(
          address.toInt,
          (address >>> 32).toInt,
          episode.size,
          number * candidates.length + first,
          count,
          first
        )
      yield word

  private def fly(part: Part, captureRadiusM: Float, into: DuelOutcomes): Unit =
    val asked  = part.worlds.asked
    val kernel = kernels.getOrElseUpdate(
      (part.forms, asked, layout),
      GpuDuelKernel(gpu, episodes.duel, episodes.timing.periodS, vehicle, part.forms, asked, layout)
    )
    val blocks                = part.blocks
    val buffers               = mutable.ArrayBuffer.empty[GpuBuffer]
    def here(made: GpuBuffer) =
      buffers += made
      made
    try
      val came = here(gpu.buffer(kernel.outcomes.toLong * part.size))
      kernel(
        blocks.length / BlockWords,
        here(gpu.buffer(blocks)),
        part.episodes.head.stride,
        part.flownBy.zipWithIndex.map((each, self) =>
          here(gpu.buffer(kernel.numbersOf(self, each.policies)))
        ),
        part.flownBy.map(each => here(gpu.buffer(each.numberOf))),
        captureRadiusM,
        part.size,
        came
      )
      val all = came.floats()
      for number <- asked; (episode, at) <- part.episodes.zipWithIndex do
        val outcome   = kernel.outcome(number, episode.scoredAtS)
        val told      = into(number)
        val first     = outcome.place * part.size + at * part.candidates.length
        var candidate = 0
        while candidate < part.candidates.length do
          told(part.worldOf(candidate, at)) = outcome(all(first + candidate))
          candidate += 1
    finally buffers.foreach(_.close())

private[lanes] object GpuDuels:
  /** Candidates of some episodes that keep a GPU busy. */
  val SideBySide: Int = 1 << 14

  /** Of some 250 kB for a minute each. */
  private val MostBytes = 1L << 30

  /** In one part: more are flown one after the other, so that a call can be cancelled. */
  private val MostWorlds  = 1 << 22
  private val MostMinutes = 1024

  /** Candidates whose policies a thread looks at at a time. */
  private val Chunk = 256

  /** @return how many were done: all, unless it was cancelled */
  private def inParallel(count: Int, chunk: Int, threads: Int, isCancelled: () => Boolean = () => false)(
      work: Int => Unit
  ): Int =
    LaneThreads.run(Vector.fill(threads)(()), WorldBatches.inOrder(count, chunk), isCancelled): (_, some) =>
      some.foreach(work)

  /** Which policies fly some candidates, each once.
    *
    * @param numberOf a candidate's among them
    */
  private final class FlownBy(val policies: Vector[Policy], val numberOf: Array[Int])

  /** Who flies one side of many candidates.
    *
    * @param threads that find out how policies fly
    */
  private final class Policies(candidates: Int, threads: Int, of: Int => Policy):
    private val policies = Array.tabulate(candidates)(of)
    private val forms    = Array.ofDim[PolicyLanes](candidates)
    // Nearly always all fly against the very same.
    inParallel(candidates, Chunk, threads): i =>
      forms(i) = if i % Chunk > 0 && (policies(i) eq policies(i - 1)) then forms(i - 1)
      else PolicyLanes.of(policies(i)).getOrElse(null)

    def areFormulas: Boolean                = !forms.contains(null)
    def formOf(candidate: Int): PolicyLanes = forms(candidate)

    def of(some: Array[Int]): FlownBy =
      val numbers  = IdentityHashMap[Policy, Integer]()
      val used     = Vector.newBuilder[Policy]
      val numberOf = some.map: candidate =>
        val known = numbers.putIfAbsent(policies(candidate), numbers.size)
        if known != null then known.intValue
        else
          used += policies(candidate)
          numbers.size - 1
      FlownBy(used.result(), numberOf)
