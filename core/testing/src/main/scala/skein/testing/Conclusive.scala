package skein.testing

import java.util.concurrent.atomic.{AtomicBoolean, AtomicLong}
import java.util.concurrent.locks.LockSupport
import scala.util.{Failure, Success, Try}

/** Tests of programs that run by the clock and cannot be told the time: they fail where the machine stops
  * them for a while, as it may a process on shared cores. Such a failure says nothing of the program.
  */
trait Conclusive extends munit.FunSuite:

  /** Runs a test again, twice at most, where it fails and the machine stood still for more than 100 ms
    * meanwhile. Where it does each time, the test is left out, and counted as inconclusive.
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

  /** What came of some work, and the longest time, ms, by which a thread that sleeps for 2 ms was late
    * meanwhile: one thread for each core.
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
