package skein.lanes.gpu

/** A call's candidates and episodes, in parts that a GPU flies at once, so that a call can be cancelled and
  * fits in memory.
  *
  * @param candidates that fly
  * @param each episodes of a candidate
  */
private[lanes] final class GpuParts(
    candidates: Array[Int],
    each: Int,
    onProgress: Int => Unit,
    isCancelled: () => Boolean
):
  import GpuParts.*

  /** Flies all, unless it is cancelled.
    *
    * @param formOf a candidate's
    * @param decisions of one episode, of all vehicles together, about
    * @param part flies candidates of a form through some of the episodes; whether it was not cancelled
    * @return how many worlds were flown
    */
  def fly[F](formOf: Int => F, decisions: F => Double)(part: (F, Array[Int], Array[Int]) => Boolean): Int =
    var done = 0
    for
      (form, alike) <- candidates.groupBy(formOf)
      episodes = (MostBytes / 4 / (BytesOfDecision * decisions(form))).toInt.max(1).min(each)
      numbers <- Array.range(0, each).grouped(episodes)
      some    <- alike.grouped((MostDecisions / (numbers.length * decisions(form))).toInt.max(1))
      if !isCancelled() && part(form, some, numbers)
    do
      done += some.length * numbers.length
      onProgress(done)
    done

private[lanes] object GpuParts:
  /** In one part: some tenths of a second for a GPU, seconds where vehicles fly in steps. */
  private val MostDecisions = 2e9

  /** An episode's operations take about half as much. */
  private val BytesOfDecision = 512

  /** Of a batch's episodes on the GPU. */
  val MostBytes: Long = 1L << 30
