package skein.flight

import java.util.concurrent.Executors

/** Work on threads of its own, which end with it. Blocks. */
private[skein] object InParallel:

  /** What each comes to, in their order; at most so many threads at once. */
  def map[A, B](all: Seq[A], threads: Int)(one: A => B): Vector[B] =
    val pool = Executors.newFixedThreadPool(threads.min(all.size).max(1))
    try all.toVector.map(each => pool.submit(() => one(each))).map(_.get())
    finally pool.shutdown()
