package skein.lanes.gpu

/** A call's candidates and episodes, in parts that a GPU processes as one, so that a call can be cancelled
  * and fits in memory.
  *
  * @param candidates to simulate
  * @param each episodes of a candidate
  */
private[lanes] final class GpuParts(
    candidates: Array[Int],
    each: Int,
    onProgress: Int => Unit,
    isCancelled: () => Boolean
):
  import GpuParts.*

  /** Simulates all, unless it is cancelled.
    *
    * @param formOf a candidate's
    * @param decisions of one episode, of all vehicles together, approximately
    * @param part simulates candidates of a form in some of the episodes; false if it was cancelled
    * @return number of simulated worlds
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
  /** Limit of decisions in one part: some tenths of a second for a GPU, seconds where vehicles move in steps.
    */
  private val MostDecisions = 2e9

  /** Bytes per decision; an episode's operations take about half of them. */
  private val BytesOfDecision = 512

  /** Limit of a batch's episodes on the GPU, bytes. */
  val MostBytes: Long = 1L << 30
