package skein.lanes.gpu

import skein.gpu.{Gpu, GpuBuffer}
import skein.lanes.{LaneThreads, Worlds}
import skein.lanes.timetable.Timetable

/** A cache of episodes in a GPU's memory, for a number of vehicles. Mutable.
  *
  * @param shows see [[GpuLayout]]
  * @param threads number of threads that make timetables
  * @param mostBytes maximum size of the cache, unless one call needs more
  */
private[lanes] final class GpuEpisodes(
    gpu: Gpu,
    vehicles: Int,
    shows: Boolean,
    threads: Int,
    mostBytes: Long
):
  import GpuEpisodes.Held
  private val held  = java.util.LinkedHashMap[Any, Held](16, 0.75f, true)
  private var bytes = 0L
  private var now   = GpuLayout(vehicles, shows)

  def layout: GpuLayout = now

  /** Uploads those episodes that are not cached.
    *
    * @param names key of each episode: everything on which it depends
    * @param timetable makes the timetable of an episode, from its index; called by several threads
    *   simultaneously
    * @return the episodes in order; None if the upload was cancelled
    */
  def bring(
      names: Vector[Any],
      isCancelled: () => Boolean
  )(timetable: Int => Timetable): Option[Vector[Held]] =
    bring(names, isCancelled, timetable, Map.empty)

  /** Uploads those episodes that are not cached.
    *
    * @param known timetables that already exist, by key
    */
  private def bring(
      names: Vector[Any],
      isCancelled: () => Boolean,
      timetable: Int => Timetable,
      known: Map[Any, Timetable]
  ): Option[Vector[Held]] =
    // An access makes an episode the most recently used.
    val missing = names.indices.filter(i => held.get(names(i)) == null).distinctBy(names)
    val made    = missing.map(i => known.getOrElse(names(i), null)).toArray
    val ready   = GpuEpisodes.inParallel(missing.length, 1, threads, isCancelled): i =>
      if made(i) == null then made(i) = timetable(missing(i))
    if ready < missing.length then None
    else
      val needed = made.foldLeft(layout)(_.holding(_))
      if needed != layout then
        now = needed
        forget(0, Set.empty)
        bring(names, isCancelled, timetable, missing.map(names).zip(made).toMap)
      else
        forget(mostBytes, names.toSet)
        val packed = Array.ofDim[GpuTimetable](made.length)
        GpuEpisodes.inParallel(made.length, 1, threads)(i => packed(i) = GpuTimetable(made(i), layout)): Unit
        for (i, timetable) <- missing.zip(packed) do
          val told = Held(gpu, timetable)
          held.put(names(i), told): Unit
          bytes += told.bytes
        Some(names.iterator.map(held.get).toVector)

  /** Evicts the least recently used episodes until the cache has at most `most` bytes; never evicts a needed
    * one.
    */
  private def forget(most: Long, needed: Set[Any]): Unit =
    val eldest = held.entrySet.iterator
    while bytes > most && eldest.hasNext do
      val old = eldest.next()
      if !needed(old.getKey) then
        bytes -= old.getValue.bytes
        old.getValue.buffer.close()
        eldest.remove()

private[lanes] object GpuEpisodes:
  final class Held(gpu: Gpu, timetable: GpuTimetable):
    val buffer: GpuBuffer       = gpu.buffer(timetable.words)
    val bytes: Long             = 4L * timetable.words.length
    val size: Int               = timetable.size
    val stride: Int             = timetable.stride
    val scoredAtS: Array[Float] = timetable.scoredAtS

  def candidatesOf(worlds: Worlds): Int =
    val each = worlds.episodesOfEach
    require(worlds.size % each == 0, s"${worlds.size} worlds are not $each episodes of every candidate")
    worlds.size / each

  def worldsOf(candidates: Array[Int], each: Int): Array[Int] =
    candidates.flatMap(candidate => Array.range(candidate * each, (candidate + 1) * each))

  /** Runs work for each number below a count on several threads.
    *
    * @param chunk number of calls of `work` that a thread makes in a row
    * @return number of calls; `count` unless it was cancelled
    */
  def inParallel(count: Int, chunk: Int, threads: Int, isCancelled: () => Boolean = () => false)(
      work: Int => Unit
  ): Int =
    val batches = Array.range(0, count).grouped(chunk).toArray
    LaneThreads.run(Vector.fill(threads)(()), batches, isCancelled)((_, some) => some.foreach(work))
