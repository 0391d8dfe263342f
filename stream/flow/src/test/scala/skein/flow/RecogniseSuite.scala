package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.Attributes
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.signal.{SplitMix64, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

class RecogniseSuite extends munit.FunSuite:
  private final case class Run(
      emitted: Seq[(frame: Int, ageMs: Double)],
      skipped: Vector[String],
      replaced: Int,
      mostAtOnce: Int
  )

  /** Frames at a camera's rate, the newest of which waits; recognition of each takes `tookMs`. */
  private def run(
      perSecond: Int,
      count: Int,
      workers: Int,
      deadlineMs: Double = 1000,
      newestFirst: Boolean = false
  )(
      tookMs: Int => Double
  ): Run =
    var skipped        = Vector.empty[String]
    var replaced       = 0
    var (atOnce, most) = (0, 0)
    var busy           = Set.empty[Int]
    val emitted        = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock                                                    = Clock.ofNanos(VirtualTime.clock(system))
      def recognise(worker: Int, frame: Stamped[Int]): Future[Int] =
        assert(!busy(worker), s"worker $worker has two frames")
        busy += worker
        atOnce += 1
        most = most.max(atOnce)
        val took = tookMs(frame.value)
        after(Span.ofMillis(took.abs).toDuration)(Future.unit).map: _ =>
          busy -= worker
          atOnce -= 1
          if took < 0 then sys.error("blurred") else frame.value
      def skip(what: Unrecognised[Int]) = skipped :+= (what match
        case Unrecognised.Late(frame)          => s"late ${frame.value}"
        case Unrecognised.Failed(frame, cause) => s"${cause.getMessage} ${frame.value}"
        case Unrecognised.Overtaken(frame)     => s"overtaken ${frame.value}")
      Source
        .tick(Duration.Zero, Span.ofSeconds(1.0 / perSecond).toDuration, ())
        .take(count)
        .zipWithIndex
        .map: (_, i) =>
          val now = clock.now()
          Stamped(i.toInt, now, now, now)
        .via(Newest(_ => replaced += 1))
        .via(Recognise(workers, Span.ofMillis(deadlineMs), clock, newestFirst)(recognise)(skip))
        .map: result =>
          assertEqualsDouble(result.took.toMillis, tookMs(result.found.value), 1e-5)
          (frame = result.found.value, ageMs = clock.now().since(result.found.validAt).toMillis)
        .runWith(Sink.seq)
    .value
    Run(emitted, skipped, replaced, most)

  test("two workers that need 20 ms each keep all of 90 frames per second, in order and 20 ms old"):
    val two = run(perSecond = 90, count = 900, workers = 2)(_ => 20)
    assertEquals(two.emitted.map(_.frame), 0 until 900)
    assert(two.emitted.forall(_.ageMs < 20.001), two.emitted.map(_.ageMs).max)
    assertEquals((two.skipped, two.replaced, two.mostAtOnce), (Vector.empty, 0, 2))

  test("one worker keeps half of the frames, always the newest, and the rest is counted"):
    val one = run(perSecond = 90, count = 900, workers = 1)(_ => 20)
    assertEquals(one.emitted.size + one.replaced, 900)
    assertEqualsDouble(one.emitted.size, 500, 2)
    assert(one.emitted.forall(_.ageMs < 20 + 1000.0 / 90 + 0.01), one.emitted.map(_.ageMs).max)

  test("results are in the order of exposure however long each takes"):
    val random = SplitMix64(1)
    val tookMs = Vector.fill(300)(5 + 80 * random.nextDouble())
    val mixed  = run(perSecond = 60, count = 300, workers = 3)(tookMs)
    assertEquals(mixed.emitted.map(_.frame), mixed.emitted.map(_.frame).sorted)
    assertEquals(mixed.emitted.size + mixed.replaced, 300)
    assertEquals(mixed.mostAtOnce, 3)

  test("twice as many frames as workers may wait behind an unfinished frame; no other starts until it ends"):
    val held = run(perSecond = 100, count = 80, workers = 2)(frame => if frame == 0 then 505 else 5)
    assertEquals(held.emitted.map(_.frame), Seq(0, 1, 2, 3) ++ (50 until 80))
    assertEquals((held.replaced, held.skipped), (46, Vector.empty))

  test("with newestFirst, a result is emitted immediately, and older ones are not"):
    val newest = run(perSecond = 100, count = 4, workers = 4, newestFirst = true)(Vector(50, 5, 45, 5))
    assertEquals(newest.emitted.map(_.frame), Seq(1, 3))
    assertEquals(newest.skipped.toSet, Set("overtaken 0", "overtaken 2"))
    assert(newest.emitted.forall(_.ageMs < 5.001))
    // A later frame still in progress has overtaken none.
    val both = run(perSecond = 100, count = 2, workers = 2, newestFirst = true)(Vector(15, 50))
    assertEquals((both.emitted.map(_.frame), both.skipped), (Seq(0, 1), Vector.empty))

  test("late and failed frames are reported and stop nothing, and a late worker gets no frame until it ends"):
    val tookMs = Vector(10.0, 500.0, -10.0) ++ Vector.fill(20)(10.0)
    val faulty = run(perSecond = 50, count = 20, workers = 2, deadlineMs = 60)(tookMs)
    assertEquals(faulty.emitted.map(_.frame), 0 +: (3 until 20))
    assertEquals(faulty.skipped, Vector("blurred 2", "late 1"))
    assertEquals(faulty.mostAtOnce, 2)

  test("without demand at most twice as many frames as workers wait, and each frame taken admits one more"):
    val begun = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      var begun   = 0
      val results = Source(1 to 20)
        .map: i =>
          val at = Instant.ofNanos(i)
          Stamped(i, at, at, at)
        .via(Recognise[Int, Int](2, Span.ofSeconds(1), clock): (_, frame) =>
          begun += 1
          Future.successful(frame.value)
        (_ => ()))
        .runWith(Sink.queue(1).withAttributes(Attributes.inputBuffer(1, 1)))
      def later() = after(100.millis)(Future.successful(begun))
      for
        atFirst <- later()
        _       <- results.pull()
        then_   <- later()
      yield
        results.cancel()
        (atFirst, then_)
    // One is held for downstream, four wait behind it.
    assertEquals(begun.value, (5, 6))

  test("frames are ordered by the given function, which here takes a restarted simulator's frames as newer"):
    val emitted = VirtualTime.run(seed = 1): system =>
      given ActorSystem                  = system
      val clock                          = Clock.ofNanos(VirtualTime.clock(system))
      def frame(run: Int, validAt: Long) =
        Stamped(run, Instant.ofNanos(validAt), Instant.Epoch, Instant.ofNanos(1000))
      // All were requested together, so two alone are not conclusive.
      Source(Vector(frame(0, 500), frame(1, 10), frame(0, 600)))
        .via(Recognise[Int, Int](
          1,
          Span.ofSeconds(1),
          clock,
          isNewer = (one, other) => one.value.asInstanceOf[Int] > other.value.asInstanceOf[Int]
        )((_, frame) => Future.successful(frame.value))(_ => ()))
        .map(_.found.validAt.toNanos)
        .runWith(Sink.seq)
    assertEquals(emitted.value, Seq(500L, 10L))

  test("zero workers and a zero deadline are refused"):
    for (workers, deadlineMs) <- Seq((0, 40.0), (1, 0.0)) do
      intercept[IllegalArgumentException](
        Recognise[Int, Int](workers, Span.ofMillis(deadlineMs), Clock.ofNanos(() => 0L))((_, _) =>
          Future.never
        )(_ => ())
      )

  test("a completing flow waits for frames in progress, until their deadline"):
    val ending = run(perSecond = 100, count = 2, workers = 2, deadlineMs = 40)(Vector(10, 5000))
    assertEquals(ending.emitted.map(_.frame), Seq(0))
    assertEquals(ending.skipped, Vector("late 1"))
