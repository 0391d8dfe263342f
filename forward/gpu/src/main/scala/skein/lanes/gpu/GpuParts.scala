package skein.lanes.gpu

/** Divides the candidates and episodes of a call into parts that a GPU processes at a time, so that a call
  * can be cancelled and fits in memory.
  *
  * @param candidates indices of the candidates to simulate
  * @param each number of episodes per candidate
  */
private[lanes] final class GpuParts(
    candidates: Array[Int],
    each: Int,
    onProgress: Int => Unit,
    isCancelled: () => Boolean
):
  import GpuParts.*

  /** Simulates all parts, unless it is cancelled.
    *
    * @param formOf the form of a candidate
    * @param decisions approximate number of decisions in one episode, of all vehicles together
    * @param part simulates candidates of one form in some of the episodes; false if it was cancelled
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
  /** Maximum number of decisions in one part: some tenths of a second on a GPU, or seconds if vehicles move
    * in steps.
    */
  private val MostDecisions = 2e9

  /** Bytes per decision of an episode, of which its operations take about half. */
  private val BytesOfDecision = 512

  /** Maximum size of the episodes in a GPU's memory, bytes. */
  val MostBytes: Long = 1L << 30
