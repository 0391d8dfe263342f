package skein.lanes

import java.util.IdentityHashMap
import scala.collection.mutable
import skein.gpu.{Gpu, GpuBuffer}
import skein.policy.Policy

/** Flies candidates that share episodes on a GPU, by [[GpuDuelKernel]]. The operations of an episode stay
  * there from call to call. Mutable; one call at a time.
  *
  * @param threads that make timetables
  */
private[lanes] final class GpuDuels(gpu: Gpu, episodes: DuelEpisodes, threads: Int):
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

  /** Flies all worlds, unless it is cancelled. All policies must be formulas.
    *
    * @return how many worlds were flown
    */
  def fly(
      worlds: DuelWorlds,
      captureRadiusM: Float,
      into: DuelOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Int =
    val evaders  = Policies(worlds.size, worlds.evader)
    val pursuers = Policies(worlds.size, worlds.pursuer)
    val byForms  = Array.range(0, worlds.size).groupBy(i => Forms(evaders.formOf(i), pursuers.formOf(i)))
    var done     = 0
    for (forms, some) <- byForms do
      val flownBy = Vector(evaders, pursuers).map(_.of(some))
      for
        part <- Part.of(some, mostEpisodes)(world => episodes.of(worlds.link(world), worlds.key(world)))
        if !isCancelled() && prepare(part, worlds, isCancelled)
      do
        fly(part, forms, flownBy, worlds.asked, captureRadiusM, into)
        done += part.worlds.length
        onProgress(done)
    done

  private def mostEpisodes = (MostMinutes * 60 / episodes.duel.durationS).toInt.max(1)

  /** Brings a part's episodes to the GPU.
    *
    * @return whether they are there: not if it was cancelled
    */
  private def prepare(part: Part, worlds: DuelWorlds, isCancelled: () => Boolean): Boolean =
    // Whoever is used now is forgotten last.
    val missing = part.stretches.filter(each => held.get(each.episode) == null).distinctBy(_.episode)
    val made    = Array.ofDim[Timetable](missing.size)
    val ready   =
      LaneThreads.run(Vector.fill(threads)(()), WorldBatches.inOrder(missing.size, 1), isCancelled):
        (_, some) =>
          for i <- some do
            val world = part.worlds(missing(i).first)
            made(i) = episodes.timetable(worlds.link(world), worlds.key(world))
    if ready < missing.size then false
    else
      val needed = made.foldLeft(layout)(_.holding(_))
      if needed != layout then
        layout = needed
        forget(most = 0)
        prepare(part, worlds, isCancelled)
      else
        forget(most = MostBytes)
        for (stretch, timetable) <- missing.zip(made) do
          val now = Held(GpuTimetable(timetable, layout))
          held.put(stretch.episode, now): Unit
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

  private def fly(
      part: Part,
      forms: Forms,
      flownBy: Vector[FlownBy],
      asked: Set[DuelNumber],
      captureRadiusM: Float,
      into: DuelOutcomes
  ): Unit =
    val kernel = kernels.getOrElseUpdate(
      (forms, asked, layout),
      GpuDuelKernel(gpu, episodes.duel, episodes.timing.periodS, episodes.model, forms, asked, layout)
    )
    val count  = part.worlds.length
    val blocks = Array.newBuilder[Int]
    for stretch <- part.stretches; first <- stretch.first until stretch.end by BlockWorlds do
      val of = held.get(stretch.episode)
      blocks ++= Array(
        of.buffer.address.toInt,
        (of.buffer.address >>> 32).toInt,
        of.size,
        first,
        BlockWorlds.min(stretch.end - first),
        0
      )
    val told                  = blocks.result()
    val buffers               = mutable.ArrayBuffer.empty[GpuBuffer]
    def here(made: GpuBuffer) =
      buffers += made
      made
    try
      val came = here(gpu.buffer(kernel.outcomes.toLong * count))
      kernel(
        told.length / BlockWords,
        here(gpu.buffer(told)),
        held.get(part.stretches.head.episode).stride,
        flownBy.zipWithIndex.map((each, self) => here(gpu.buffer(kernel.numbersOf(self, each.policies)))),
        flownBy.map(each => here(gpu.buffer(part.worlds.map(each.numberOf)))),
        captureRadiusM,
        count,
        came
      )
      val all = came.floats()
      for number <- asked; stretch <- part.stretches do
        val (place, tell) = kernel.outcome(number, held.get(stretch.episode).scoredAtS)
        val told          = into(number)
        var i             = stretch.first
        while i < stretch.end do
          told(part.worlds(i)) = tell(all(place * count + i))
          i += 1
    finally buffers.foreach(_.close())

private object GpuDuels:
  /** Of some 250 kB for a minute each. */
  private val MostBytes = 1L << 30

  /** In one part: more are flown one after the other, so that a call can be cancelled. */
  private val MostWorlds  = 1 << 22
  private val MostMinutes = 1024

  /** Worlds that fly through one episode: those of a part from the first on. */
  private final case class Stretch(episode: Any, first: Int, end: Int)

  /** Worlds that one launch flies, those of an episode side by side. */
  private final class Part(val worlds: Array[Int], val stretches: Vector[Stretch])

  private object Part:
    def of(worlds: Array[Int], mostEpisodes: Int)(episodeOf: Int => Any): Iterator[Part] =
      val byEpisode = mutable.LinkedHashMap.empty[Any, mutable.ArrayBuilder[Int]]
      for world <- worlds do byEpisode.getOrElseUpdate(episodeOf(world), Array.newBuilder[Int]) += world
      val stretches =
        byEpisode.iterator.flatMap((episode, some) => some.result().grouped(MostWorlds).map((episode, _)))
      Iterator.unfold(stretches.buffered): left =>
        Option.when(left.hasNext):
          val taken           = Vector.newBuilder[Stretch]
          val all             = Array.newBuilder[Int]
          var count, episodes = 0
          while left.hasNext && episodes < mostEpisodes && count + left.head._2.length <= MostWorlds do
            val (episode, some) = left.next()
            taken += Stretch(episode, count, count + some.length)
            all ++= some
            count += some.length
            episodes += 1
          (Part(all.result(), taken.result()), left)

  /** Which policies fly some worlds, each once.
    *
    * @param numberOf a world's among them
    */
  private final class FlownBy(val policies: Vector[Policy], val numberOf: Int => Int)

  /** Who flies one side of many worlds. */
  private final class Policies(worlds: Int, of: Int => Policy):
    private val known    = IdentityHashMap[Policy, Integer]()
    private val policies = mutable.ArrayBuffer.empty[Policy]
    private val forms    = mutable.ArrayBuffer.empty[PolicyLanes]
    private val numberOf = Array.tabulate(worlds): world =>
      val policy = of(world)
      known.computeIfAbsent(
        policy,
        _ =>
          policies += policy
          forms += PolicyLanes.get(policy)
          policies.size - 1
      ).intValue

    def formOf(world: Int): PolicyLanes = forms(numberOf(world))

    def of(some: Array[Int]): FlownBy =
      val renumbered = Array.fill(policies.size)(-1)
      val used       = Vector.newBuilder[Policy]
      var count      = 0
      for world <- some if renumbered(numberOf(world)) < 0 do
        renumbered(numberOf(world)) = count
        used += policies(numberOf(world))
        count += 1
      FlownBy(used.result(), world => renumbered(numberOf(world)))
