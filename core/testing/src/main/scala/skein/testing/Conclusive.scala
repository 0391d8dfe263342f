package skein.testing

import java.util.concurrent.atomic.{AtomicBoolean, AtomicLong}
import java.util.concurrent.locks.LockSupport
import scala.util.{Failure, Success, Try}

/** Tests of programs that depend on the real clock. They fail when the machine suspends them, as it may on
  * shared cores; such a failure says nothing about the program.
  */
trait Conclusive extends munit.FunSuite:

  /** Repeats a failed test, at most twice, if the machine was suspended for more than 100 ms during it. A
    * test that fails in this way each time is skipped, and counted as inconclusive.
    */
  def conclusive(test: => Unit): Unit =
    def attempt(left: Int): Unit =
      val (outcome, stillMs) = Conclusive.standstillMs(Try(test))
      outcome match
        case Success(())                                                => ()
        case Failure(failure) if stillMs <= Conclusive.MostStandstillMs => throw failure
        case Failure(failure) if left > 0                               =>
          println(s"again, for the machine stood still for $stillMs ms: ${failure.getMessage}")
          attempt(left - 1)
        case Failure(failure) =>
          // .ci/run counts such lines.
          println(s"INCONCLUSIVE: the machine stood still for $stillMs ms: ${failure.getMessage}")
          assume(false, "inconclusive")
    attempt(left = 2)

private object Conclusive:
  val MostStandstillMs = 100L

  /** Does some work, and measures how long the machine is suspended; one thread for each core sleeps for 2 ms
    * at a time.
    *
    * @return the result of the work, and the longest delay with which a thread woke, ms
    */
  def standstillMs[A](work: => A): (A, Long) =
    val latest  = AtomicLong()
    val ended   = AtomicBoolean()
    val watches = Vector.fill(Runtime.getRuntime.availableProcessors):
      Thread.ofPlatform().daemon().name("standstill").start: () =>
        var before = System.nanoTime()
        while !ended.get do
          LockSupport.parkNanos(2_000_000)
          val now  = System.nanoTime()
          val late = now - before - 2_000_000
          latest.accumulateAndGet(late, (a, b) => math.max(a, b)): Unit
          before = now
    val result = work
    ended.set(true)
    watches.foreach(_.join())
    (result, latest.get / 1_000_000)
