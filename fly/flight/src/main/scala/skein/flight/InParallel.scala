package skein.flight

import java.util.concurrent.{ExecutionException, ExecutorCompletionService, Executors, Future}

/** Runs work on separate threads. An exception of one is thrown to the caller, and no further work is
  * started. Blocks. Too slow for pieces of work that take microseconds.
  */
private[skein] object InParallel:

  /** Ordered parallel map on at most `threads` threads. */
  def map[A, B](all: Seq[A], threads: Int)(one: A => B): Vector[B] =
    val pool = Executors.newFixedThreadPool(threads.min(all.size).max(1))
    try all.toVector.map(each => pool.submit(() => one(each))).map(result)
    finally
      val _ = pool.shutdownNow()

  /** Parallel map that passes each result to `use` on the calling thread as soon as it is ready. `all` may be
    * infinite: the next element is taken when one has ended.
    */
  def asTheyCome[A, B](all: Iterator[A], threads: Int)(one: A => B)(use: B => Unit): Unit =
    val pool                 = Executors.newFixedThreadPool(threads)
    val ended                = ExecutorCompletionService[B](pool)
    def submitted(): Boolean =
      val isMore = all.hasNext
      if isMore then
        val each = all.next()
        ended.submit(() => one(each)): Unit
      isMore
    try
      var underWay = (0 until threads).count(_ => submitted())
      while underWay > 0 do
        val came = result(ended.take())
        if !submitted() then underWay -= 1
        use(came)
    finally
      val _ = pool.shutdownNow()

  private def result[B](of: Future[B]): B =
    try of.get()
    catch case failed: ExecutionException => throw failed.getCause
