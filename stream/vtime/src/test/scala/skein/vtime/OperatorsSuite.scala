package skein.vtime

import java.util.concurrent.TimeoutException
import org.apache.pekko.actor.{Actor, ActorSystem, Props, Timers}
import org.apache.pekko.pattern.{AskTimeoutException, CircuitBreaker, CircuitBreakerOpenException, after, ask}
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.stream.{DelayOverflowStrategy, RestartSettings, ThrottleMode}
import org.apache.pekko.util.Timeout
import scala.concurrent.Future
import scala.concurrent.duration.*

/** Each operator that reads a clock or sets a timer, compared with its exact times. */
class OperatorsSuite extends munit.FunSuite:

  /** Times of the elements, milliseconds since the start. */
  private def times[A](source: ActorSystem => Source[A, ?]): Seq[(A, Double)] =
    VirtualTime.run(1): system =>
      given ActorSystem = system
      val millis        = elapsedMillis(system)
      source(system).map(element => element -> millis()).runWith(Sink.seq)
    .value

  private def elapsedMillis(system: ActorSystem): () => Double =
    val clock = VirtualTime.clock(system)
    val start = clock()
    () => (clock() - start) / 1e6

  private def ticks = Source.tick(0.millis, 100.millis, ()).scan(0)((count, _) => count + 1).drop(1)

  test("tick emits at its initial delay and then at every interval"):
    val ticked = times(_ => Source.tick(30.millis, 100.millis, "t").take(4))
    assertEquals(ticked.map(_._2), Seq(30.0, 130.0, 230.0, 330.0))

  test("throttle spaces elements exactly, after its burst"):
    val shaped = times(_ => Source(1 to 5).throttle(1, 250.millis, 2, ThrottleMode.Shaping))
    assertEquals(shaped, Seq(1 -> 0.0, 2 -> 0.0, 3 -> 250.0, 4 -> 500.0, 5 -> 750.0))

  test("delay holds every element for its time"):
    val delayed = times(_ => ticks.take(3).delay(450.millis, DelayOverflowStrategy.backpressure))
    assertEquals(delayed, Seq(1 -> 450.0, 2 -> 550.0, 3 -> 650.0))

  test("initialDelay holds the first element"):
    assertEquals(times(_ => Source(1 to 2).initialDelay(1.second)), Seq(1 -> 1000.0, 2 -> 1000.0))

  test("takeWithin and dropWithin cut at their time"):
    assertEquals(times(_ => ticks.takeWithin(250.millis)).map(_._1), Seq(1, 2, 3))
    assertEquals(times(_ => ticks.dropWithin(250.millis).take(2)), Seq(4 -> 300.0, 5 -> 400.0))

  test("groupedWithin emits the elements received so far when its time has elapsed"):
    val grouped = times(_ => ticks.groupedWithin(100, 250.millis).take(2))
    assertEquals(grouped, Seq(Seq(1, 2, 3) -> 250.0, Seq(4, 5) -> 500.0))

  test("keepAlive injects an element whenever its time passes in silence"):
    val kept = times(_ => Source.tick(0.millis, 1.second, "real").keepAlive(400.millis, () => "kept").take(5))
    assertEquals(kept.map(_._1), Seq("real", "kept", "kept", "real", "kept"))
    assertEquals(kept.map(_._2), Seq(0.0, 400.0, 800.0, 1000.0, 1400.0))

  test("idleTimeout fails at its first check after the silence, and checks every eighth of the timeout"):
    val failedAt = VirtualTime.run(1): system =>
      given ActorSystem = system
      import system.dispatcher
      val millis = elapsedMillis(system)
      Source.single(1).concat(Source.maybe[Int]).idleTimeout(800.millis).runWith(Sink.seq).failed
        .map(error => (error.isInstanceOf[TimeoutException], millis()))
    .value
    assertEquals(failedAt, (true, 900.0))

  test("completionTimeout, initialTimeout and backpressureTimeout fail on time"):
    def failure(limited: Source[Int, ?] => Source[Int, ?]) =
      val run = VirtualTime.run(1): system =>
        given ActorSystem = system
        limited(Source.single(1).concat(Source.maybe[Int])).runWith(Sink.ignore).failed
      assert(run.value.isInstanceOf[TimeoutException])
      run.duration
    assertEquals(failure(_.completionTimeout(700.millis)), 700.millis)
    assertEquals(failure(_.drop(1).initialTimeout(300.millis)), 300.millis)
    // Demand ends at 0; the first check, of those 100 ms apart, after more than 800 ms:
    assertEquals(failure(_.backpressureTimeout(800.millis).mapAsync(1)(_ => Future.never)), 900.millis)

  test("a circuit breaker lets a call through again exactly when its reset time has elapsed"):
    val run = VirtualTime.run(1): system =>
      import system.dispatcher
      val breaker =
        CircuitBreaker(system.scheduler, maxFailures = 1, callTimeout = 1.second, resetTimeout = 5.seconds)
      def probe(): Future[Unit] = breaker
        .withCircuitBreaker(Future.unit)
        .recoverWith { case _: CircuitBreakerOpenException => after(1.milli)(probe())(using system) }
      breaker.withCircuitBreaker(Future.failed(RuntimeException("down"))).recoverWith { case _ => probe() }
    assertEquals(run.duration, 5.seconds)

  test("mapAsync keeps the order of answers that arrive at different times"):
    val answered = times: system =>
      Source(Seq(300, 100, 200)).mapAsync(3)(ms => after(ms.millis)(Future.successful(ms))(using system))
    assertEquals(answered, Seq(300 -> 300.0, 100 -> 300.0, 200 -> 300.0))

  test("an ask times out exactly when its time has elapsed"):
    val failedAt = VirtualTime.run(1): system =>
      import system.dispatcher
      given Timeout = 5.seconds
      val millis    = elapsedMillis(system)
      (system.actorOf(Props(Silent())) ? "anybody?").failed.map(error => (error.getClass, millis()))
    .value
    assertEquals(failedAt, (classOf[AskTimeoutException], 5000.0))

  test("RestartSource backs off by its seeded jitter, equal for equal seeds"):
    def starts(seed: Long) = VirtualTime.run(seed): system =>
      given ActorSystem = system
      val millis        = elapsedMillis(system)
      val settings      = RestartSettings(100.millis, 10.seconds, 0.5).withMaxRestarts(4, 1.minute)
      val started       = Seq.newBuilder[Double]
      RestartSource
        .withBackoff(settings): () =>
          started += millis()
          Source.failed[Nothing](RuntimeException("down"))
        .runWith(Sink.ignore)
        .failed
        .map(_ => started.result())(using system.dispatcher)
    .value
    val first = starts(7)
    assertEquals(first.size, 5)
    first.sliding(2).zip(Iterator.iterate(100.0)(_ * 2)).foreach: (pair, least) =>
      val waited = pair(1) - pair(0)
      assert(waited >= least && waited <= 1.5 * least, s"waited $waited, at least $least was due")
    assertEquals(starts(7), first)
    assertNotEquals(starts(8), first)

  test("timers of classic actors fire on time"):
    val fired = VirtualTime.run(1): system =>
      val promise = scala.concurrent.Promise[Double]()
      system.actorOf(Props(Alarm(elapsedMillis(system), promise))): Unit
      promise.future
    .value
    assertEquals(fired, 1500.0)

private final class Silent extends Actor:
  def receive: Receive = _ => ()

private final class Alarm(millis: () => Double, rung: scala.concurrent.Promise[Double]) extends Actor
    with Timers:
  timers.startTimerAtFixedRate("beat", "beat", 500.millis)
  private var beats = 0

  def receive: Receive = _ =>
    beats += 1
    if beats == 3 then
      rung.success(millis()): Unit
      context.stop(self)
