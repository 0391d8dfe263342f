package skein.forward

import scala.collection.mutable.ArrayBuffer
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.Span
import skein.vehicle.ReducedModel

class ImageTimingSuite extends munit.FunSuite:
  private val plant = PlantResponse(ReducedModel.AirSimLag)

  /** Images are on their way, in recognition and waiting at any time. */
  private val busy =
    GuideCamera.model.copy(takes = LatencyDistribution.Uniform(Span.ofMillis(150), Span.ofMillis(290)))
  private val link = DelayTable.of(LatencyDistribution.Uniform(Span.ofMillis(20), Span.ofMillis(180)))

  private def rollout(takes: LatencyDistribution, deadlineS: Double, timing: LoopTiming) =
    val camera = busy.copy(takes = takes, deadlineS = deadlineS)
    val paper  = Duel.paper
    Rollout(paper.copy(pursuer = paper.pursuer.copy(eye = Some(camera)), durationS = 12), timing, link, plant)

  for
    timing <- Seq(
      LoopTiming.Paused(),
      LoopTiming.Sequential(),
      LoopTiming.Futures(),
      LoopTiming.Stream(),
      LoopTiming.Predictive(predictor = plant.predictor)
    )
  do
    test(s"${timing.productPrefix}: images of one flight leave nothing behind for the next"):
      val again = rollout(busy.takes, 0.3, timing)
      def fly() = again.fly(WorldRandom.key(2, 0, 1))
      val first = fly()
      assert(again.fly(WorldRandom.key(2, 0, 2)) != first)
      assertEquals(fly(), first)

  test("an image recognised at its deadline counts, and one a nanosecond later does not"):
    def flown(takes: Span, deadlineS: Double) =
      rollout(LatencyDistribution.Constant(takes), deadlineS, LoopTiming.Stream()).fly(1)
    val late = Span.ofMillis(200)
    assertEquals(flown(late, 0.2), flown(late, 1))
    assertEquals(flown(late + Span.ofNanos(1), 0.2), flown(Span.ofSeconds(2), 0.2))
    assert(flown(late + Span.ofNanos(1), 0.2) != flown(late, 0.2))

  /** The images taken and those known within a time, each with when that was, ms. */
  private def images(oneWayMs: Int, takesMs: Int, workers: Int, untilMs: Int) =
    val link  = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(2 * oneWayMs)))
    val world = RolloutWorld(
      Engagement.of(Duel.paper),
      link,
      plant,
      Asking(),
      keepsAll = false,
      standsStill = false,
      RolloutWorld.Ring
    )
    val (taking, knowing) = (ArrayBuffer.empty[(Int, Long)], ArrayBuffer.empty[(Int, Long)])
    val model             =
      busy.copy(
        takes = LatencyDistribution.Constant(Span.ofMillis(takesMs)),
        workers = workers,
        deadlineS = 1
      )
    val timing = new ImageTiming(world, 0, model, link):
      protected def taken(number: Int): Unit = taking += number  -> (world.nowS * 1000).round
      protected def known(number: Int): Unit = knowing += number -> (world.nowS * 1000).round
    world.start(1, LoopObserver.Nobody)
    timing.start(1)
    while world.nextNs <= untilMs * 1_000_000L do
      val event = world.next()
      timing.handle(RolloutWorld.kindOf(event), RolloutWorld.numberOf(event))
    (taking.toVector, knowing.toVector)

  test("two images may be on their way; while as many are, none is taken"):
    assertEquals(
      images(160, 1, 2, 1000)._1,
      Vector(0, 1, 4, 5, 8).map(number => number -> (number * 100L + 160))
    )

  test("one recogniser takes the newest image that waits"):
    assertEquals(images(50, 255, 1, 1200)._2, Vector(0 -> 355L, 2 -> 610L, 5 -> 865L, 7 -> 1120L))

  test("two recognisers take turns"):
    assertEquals(images(50, 185, 2, 700)._2, Vector.tabulate(5)(number => number -> (number * 100L + 285)))
