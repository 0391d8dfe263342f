package skein.forward

import scala.collection.mutable.ArrayBuffer
import skein.signal.{Impairment, LatencyDistribution}
import skein.simd.WorldRandom
import skein.units.Span
import skein.vehicle.ReducedModel

class ImageTimingSuite extends munit.FunSuite:
  private val plant = PlantResponse(ReducedModel.AirSimLag)

  /** Images are in transit, in recognition and waiting at any time. */
  private val busy =
    GuideCamera.model.copy(takes = LatencyDistribution.Uniform(Span.ofMillis(150), Span.ofMillis(290)))
  private val link = DelayTable.of(LatencyDistribution.Uniform(Span.ofMillis(20), Span.ofMillis(180)))

  private def rollout(takes: LatencyDistribution, deadlineS: Double, timing: LoopTiming) =
    val camera = busy.copy(takes = takes, deadlineS = deadlineS)
    val paper  = Pair.paper
    ScoredRollout(
      paper.copy(pursuer = paper.pursuer.copy(eye = Some(camera)), durationS = 12).engagement,
      timing,
      link,
      plant
    )

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

  /** The images taken and those known within a time, each with when that was, ns. */
  private def images(link: Delays, takes: LatencyDistribution, workers: Int, untilMs: Int) =
    val world = RolloutWorld(
      Pair.paper.engagement,
      link,
      Vector.fill(2)(plant),
      Asking(),
      keepsAll = false,
      asksPolicies = false,
      standsStill = false,
      RolloutWorld.Ring
    )
    val (taking, knowing) = (ArrayBuffer.empty[(Int, Long)], ArrayBuffer.empty[(Int, Long)])
    val model             = busy.copy(takes = takes, workers = workers, deadlineS = 1)
    val timing            = new ImageTiming(world, 0, model, link):
      protected def taken(number: Int): Unit = taking += ((number, world.nowNs))
      protected def known(number: Int): Unit = knowing += ((number, world.nowNs))
    world.start(1, LoopObserver.Nobody)
    timing.start(1)
    while world.nextNs <= untilMs * 1_000_000L do
      val event = world.next()
      timing.handle(RolloutWorld.kindOf(event), RolloutWorld.numberOf(event))
    (taking.toVector, knowing.toVector)

  private def steady(oneWayMs: Int) =
    DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(2 * oneWayMs)))

  /** When images are known, ms. */
  private def known(oneWayMs: Int, takesMs: Int, workers: Int, untilMs: Int) =
    images(steady(oneWayMs), LatencyDistribution.Constant(Span.ofMillis(takesMs)), workers, untilMs)._2
      .map((number, ns) => number -> (ns * 1e-6).round)

  test("images share a link's busy stretches and outages with control, but not its single delays"):
    val none           = LatencyDistribution.Constant(Span.Zero)
    val mixed          = AlternatingDelays(steady(40), steady(10), 1, 1)
    val (lasts, every) = (Span.ofMillis(500), Span.ofSeconds(2))
    val failing        = LossyDelays.of(steady(10), Seq(Impairment.Outage(lasts, every)), 0.2, 40)
    for shared <- Seq(mixed, failing); (number, ns) <- images(shared, none, 2, 20_000)._1 do
      val sentAtNs = number * 100_000_000L
      val control  = shared.delayNs(1, Delays.command(0), number, number, sentAtNs)
      assertEquals(ns - sentAtNs, control, clue(number))
    assert(images(link, none, 2, 5000)._1.exists: (number, ns) =>
      ns - number * 100_000_000L != link.delayNs(1, Delays.question(0, 0), number, number, 0))

  test("no image is taken while two images are in transit"):
    val link   = steady(160)
    val oneWay = link.delayNs(1, Delays.question(0, 0), 0, 0, 0)
    assertEquals(
      images(link, LatencyDistribution.Constant(Span.Zero), 2, 1000)._1,
      Vector(0, 1, 4, 5, 8).map(number => number -> (number * 100_000_000L + oneWay))
    )

  test("one recogniser takes the newest image that waits"):
    assertEquals(known(50, 255, 1, 1200), Vector(0 -> 355L, 2 -> 610L, 5 -> 865L, 7 -> 1120L))

  test("two recognisers take turns"):
    assertEquals(known(50, 185, 2, 700), Vector.tabulate(5)(number => number -> (number * 100L + 285)))

  test("no image is recognised twice, whatever comes later"):
    assertEquals(known(160, 150, 1, 1100), Vector(0 -> 470L, 1 -> 620L, 4 -> 870L, 5 -> 1020L))

  test("an image whose result a newer one overtook is dropped"):
    val numbers =
      images(steady(50), LatencyDistribution.Uniform(Span.ofMillis(1), Span.ofMillis(290)), 2, 20000)
        ._2.map(_._1)
    assert(numbers.size > 100 && numbers == numbers.sorted, numbers)
