package skein.lanes

import skein.gpu.{Gpu, GpuBuffer}

/** Episodes of so many vehicles, on a GPU. Mutable.
  *
  * @param shows see [[GpuLayout]]
  * @param threads that make timetables
  * @param mostBytes that are held, unless one call needs more
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

  /** Of all that are held. */
  def layout: GpuLayout = now

  /** Brings episodes to the GPU.
    *
    * @param names of all that they depend on
    * @param timetable of one of them, by its place; made by several threads at once
    * @return none if it was cancelled
    */
  def bring(
      names: Vector[Any],
      isCancelled: () => Boolean
  )(timetable: Int => Timetable): Option[Vector[Held]] =
    // Whoever is used now is forgotten last.
    val missing = names.indices.filter(i => held.get(names(i)) == null).distinctBy(names)
    val made    = Array.ofDim[Timetable](missing.length)
    val ready   =
      GpuEpisodes.inParallel(missing.length, 1, threads, isCancelled)(i => made(i) = timetable(missing(i)))
    if ready < missing.length then None
    else
      val needed = made.foldLeft(layout)(_.holding(_))
      if needed != layout then
        now = needed
        forget(most = 0)
        bring(names, isCancelled)(timetable)
      else
        forget(mostBytes)
        val packed = Array.ofDim[GpuTimetable](made.length)
        GpuEpisodes.inParallel(made.length, 1, threads)(i => packed(i) = GpuTimetable(made(i), layout)): Unit
        for (i, timetable) <- missing.zip(packed) do
          val told = Held(gpu, timetable)
          held.put(names(i), told): Unit
          bytes += told.bytes
        Some(names.iterator.map(held.get).toVector)

  /** Those used least lately, until no more than so many bytes are held. */
  private def forget(most: Long): Unit =
    val eldest = held.values.iterator
    while bytes > most && eldest.hasNext do
      val old = eldest.next()
      bytes -= old.bytes
      old.buffer.close()
      eldest.remove()

private[lanes] object GpuEpisodes:
  /** One. */
  final class Held(gpu: Gpu, timetable: GpuTimetable):
    val buffer: GpuBuffer       = gpu.buffer(timetable.words)
    val bytes: Long             = 4L * timetable.words.length
    val size: Int               = timetable.size
    val stride: Int             = timetable.stride
    val scoredAtS: Array[Float] = timetable.scoredAtS

  /** Does something with each number below a count.
    *
    * @param chunk so many by a thread at a time
    * @return how many were done: all, unless it was cancelled
    */
  def inParallel(count: Int, chunk: Int, threads: Int, isCancelled: () => Boolean = () => false)(
      work: Int => Unit
  ): Int =
    LaneThreads.run(Vector.fill(threads)(()), WorldBatches.inOrder(count, chunk), isCancelled): (_, some) =>
      some.foreach(work)
