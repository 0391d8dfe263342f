package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.duration.*
import skein.forecast.*
import skein.signal.*
import skein.units.*
import skein.vehicle.ConstantVelocity
import skein.vtime.VirtualTime

class PredictSuite extends munit.FunSuite:
  private val skew   = Span.ofSeconds(-77)
  private val oneWay = Span.ofMillis(30)

  /** The motion of a vehicle that accelerates north, 2 m/s²; the other one rests. */
  private def north(t: Span) =
    Kinematics(
      Vector3(t.toSeconds * t.toSeconds, 0, 0),
      Vector3(2 * t.toSeconds, 0, 0),
      Quaternion.Identity,
      Vector3.Zero
    )

  /** Returns the estimates from readings every 100 ms, and their verified errors. */
  private def predicted(lead: Span = Span.Zero): (Seq[Vector[Estimate]], Seq[Verified]) =
    var verified = Vector.empty[Verified]
    val run      = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      val clock         = Clock.ofNanos(VirtualTime.clock(system))
      val start         = clock.now()
      def seen(n: Long) =
        val sampled = Span.ofMillis(100.0 * n - 30)
        val stamps  = Stamped((), start + sampled + skew, start + sampled - oneWay, start + sampled + oneWay)
        Vector(
          ForecastEvent.Seen(0, stamps.map(_ => north(sampled))),
          ForecastEvent.Seen(1, stamps.map(_ => north(Span.Zero)))
        )
      Source
        .tick(100.millis, 100.millis, ())
        .zipWithIndex
        .take(10)
        .map((_, n) => seen(n + 1))
        .scan(Forecast(Vector(ConstantVelocity, ConstantVelocity)))((forecast, event) =>
          event.foldLeft(forecast)(_.withEvent(_))
        )
        .map(forecast => ((), forecast))
        .via(Predict.whenActing(clock, lead = lead)(verified :+= _))
        .map(_._2)
        .runWith(Sink.seq)
    (run.value, verified)

  test("every vehicle is predicted over the link's round trip, once readings of all have arrived"):
    val (estimates, _) = predicted()
    assertEquals(estimates.size, 10)
    for vehicles <- estimates do assertEquals(vehicles.map(_.age), Vector(oneWay * 2, oneWay * 2))

  test("the states for commands that are sent later are predicted for a later time"):
    val (estimates, _) = predicted(lead = Span.ofMillis(25))
    for vehicles <- estimates do
      assertEquals(vehicles.map(_.age), Vector.fill(2)(oneWay * 2 + Span.ofMillis(25)))

  test("a prediction is compared with a reading of its exact time"):
    val at       = Instant.Epoch + Span.ofSeconds(1)
    val forecast = Seq(at - Span.ofMillis(50), at).foldLeft(Forecast(Vector(ConstantVelocity))):
      (known, read) =>
        known.withEvent(ForecastEvent.Seen(0, Stamped(north(Span.Zero), read, read, read)))
    val waiting = Unverified.none.withMade(at, Vector(Estimate(north(Span.ofSeconds(2)), at, at)), _ => true)
    val (left, verified) = waiting.heldAgainst(forecast)
    assertEquals((left.made, verified.map(_.error)), (Vector.empty, Vector(Metres(4))))

  test("each prediction is compared with the readings around its time, and its error is reported"):
    val (_, verified)     = predicted()
    val (moving, resting) = verified.partition(_.vehicle == 0)
    // Constant velocity is off by ½ a t² = ½ · 2 m/s² · (60 ms)².
    for one <- moving do assertEqualsDouble(one.error.value, 0.0036, 1e-9)
    for one <- resting do assertEquals(one.error.value, 0.0)
    // The last prediction's time has no reading.
    assertEquals((moving.size, resting.size), (9, 9))

  test("a prediction of a vehicle without newer readings waits"):
    val start   = Instant.Epoch
    val waiting = Unverified.none.withMade(start, Vector(Estimate(north(Span.Zero), start, start)), _ => true)
    val (left, verified) = waiting.heldAgainst(Forecast(Vector(ConstantVelocity)))
    assertEquals((left, verified), (waiting, Vector.empty))

  test("the newest unverified predictions are kept, a bounded number for each vehicle"):
    val here     = north(Span.Zero)
    val start    = Instant.Epoch
    val estimate = Estimate(here, start, start)
    val waiting  = (1 to 100).foldLeft(Unverified.none): (made, n) =>
      made.withMade(start + Span.ofMillis(n.toDouble), Vector(estimate, estimate, estimate), of = _ != 1)
    assertEquals(waiting.made.size, Unverified.Limit * 3)
    assertEquals(waiting.made.map(_.vehicle).toSet, Set(0, 2))
    assertEquals(waiting.made.last.at, start + Span.ofMillis(100))
