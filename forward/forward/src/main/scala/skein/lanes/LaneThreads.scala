package skein.lanes

import java.time.Duration
import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}

/** Distributes batches of worlds to workers, each on its own thread. A worker reuses its arrays from batch to
  * batch; cancellation is checked between batches.
  */
private[lanes] object LaneThreads:

  /** Runs the workers until all batches are done.
    *
    * @param isCancelled polled before each batch, from any thread, and during batches by the caller. When it
    *   is true, working threads are interrupted, and a batch that throws because of that is abandoned
    * @param onProgress called with the number of simulated worlds, after each batch, by one thread at a time
    * @return number of simulated worlds
    * @throws InterruptedException if the caller is interrupted, after all running batches have ended
    */
  def run[W](
      workers: Vector[W],
      batches: Array[Array[Int]],
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
        // Every batch that was taken is completed.
        val number = if failure.get == null && !isCancelled() then next.getAndIncrement() else batches.length
        if number >= batches.length then going = false
        else
          val numbers = batches(number)
          work(worker, numbers)
          lock.synchronized:
            done += numbers.length
            onProgress(done)

    val flying = workers
      .take(batches.length)
      .map: worker =>
        val thread = Thread(() =>
          try handle(worker)
          catch
            case thrown: Throwable =>
              if !(thrown.isInstanceOf[InterruptedException] && isCancelled()) then
                failure.compareAndSet(null, thrown): Unit
        )
        thread.setDaemon(true)
        thread.setName("skein-lanes")
        thread
    flying.foreach(_.start())
    try
      for thread <- flying do
        while !thread.join(AskedEvery) do if isCancelled() then flying.foreach(_.interrupt())
    catch
      case interrupted: InterruptedException =>
        failure.compareAndSet(null, interrupted): Unit
        flying.foreach(_.join())
    if failure.get != null then throw failure.get
    done

  private val AskedEvery = Duration.ofMillis(100)
