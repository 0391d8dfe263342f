package skein.lanes

import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}
import skein.units.Expect

/** Whether this Java can compute by lanes. */
private[skein] object LaneSupport:
  /** A class with vectors is not touched where their module is missing. */
  val present: Either[String, Unit] = Expect.that(
    ModuleLayer.boot().findModule("jdk.incubator.vector").isPresent
  ):
    "the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector"

  /** Which engine flies over links, in a line for the user.
    *
    * @param lanes what flies by lanes
    * @param refusals by link, why no lanes fly over it
    * @param otherwise what does then
    */
  def told(lanes: String, refusals: Seq[Option[String]], otherwise: Option[String] = None): String =
    val refused = refusals.flatten
    if refused.isEmpty then s"SIMD, $lanes"
    else if refused.size == refusals.size then otherwise.getOrElse(s"scalar: ${refused.head}")
    else
      s"SIMD, $lanes, over ${refusals.size - refused.size} of ${refusals.size} links; " +
        s"scalar over the others: ${refused.head}"

/** Hands batches of worlds out to workers, each on a thread of its own: a worker keeps its arrays from batch
  * to batch, and is asked between them whether to go on.
  */
private[lanes] object LaneThreads:

  /** @param isCancelled asked before each batch, from any thread
    * @param onProgress is told how many worlds are done, after each batch, by one thread at a time
    * @return how many worlds were done
    * @throws InterruptedException if the caller is interrupted; the batches handed out have ended then
    */
  def run[W](
      workers: Vector[W],
      batches: WorldBatches,
      isCancelled: () => Boolean,
      onProgress: Int => Unit = _ => ()
  )(work: (W, Array[Int]) => Unit): Int =
    val failure = AtomicReference[Throwable]()
    val next    = AtomicInteger()
    val lock    = Object()
    var done    = 0

    def handle(worker: W): Unit =
      var going = true
      while going do
        // Every batch that was handed out is flown.
        val number = if failure.get == null && !isCancelled() then next.getAndIncrement() else batches.count
        if number >= batches.count then going = false
        else
          val numbers = batches(number)
          work(worker, numbers)
          lock.synchronized:
            done += numbers.length
            onProgress(done)

    val flying = workers
      .take(batches.count)
      .map: worker =>
        val thread = Thread(() =>
          try handle(worker)
          catch case thrown: Throwable => failure.compareAndSet(null, thrown): Unit
        )
        thread.setDaemon(true)
        thread.setName("skein-lanes")
        thread
    flying.foreach(_.start())
    try flying.foreach(_.join())
    catch
      case interrupted: InterruptedException =>
        failure.compareAndSet(null, interrupted): Unit
        flying.foreach(_.join())
    if failure.get != null then throw failure.get
    done

/** Which worlds fly together. */
private[lanes] final class WorldBatches(order: Array[Int], starts: Array[Int]):
  def count: Int = starts.length

  /** Numbers of the worlds. */
  def apply(batch: Int): Array[Int] =
    java.util.Arrays.copyOfRange(
      order,
      starts(batch),
      if batch + 1 < starts.length then starts(batch + 1) else order.length
    )

private[lanes] object WorldBatches:
  def inOrder(numbers: Array[Int], most: Int): WorldBatches =
    WorldBatches(numbers, Array.range(0, numbers.length, most))

  /** A batch has worlds of one key and one link.
    *
    * @param numbers of those worlds that are flown
    */
  def byEpisode(worlds: Worlds, numbers: Array[Int], most: Int): WorldBatches =
    val groups  = java.util.HashMap[(AnyRef, Int), Integer]()
    val groupOf = numbers.map: world =>
      groups.computeIfAbsent((worlds.link(world), worlds.key(world)), _ => groups.size).intValue
    val sizes = Array.ofDim[Int](groups.size)
    for group <- groupOf do sizes(group) += 1
    val ends  = sizes.scanLeft(0)(_ + _)
    val fill  = ends.clone
    val order = Array.ofDim[Int](numbers.length)
    for i <- numbers.indices do
      order(fill(groupOf(i))) = numbers(i)
      fill(groupOf(i)) += 1
    WorldBatches(order, sizes.indices.flatMap(group => ends(group) until ends(group + 1) by most).toArray)
