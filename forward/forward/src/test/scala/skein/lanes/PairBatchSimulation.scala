package skein.lanes

import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import skein.forward.{
  Asking,
  DelayTable,
  Delays,
  Pair,
  LinkDelays,
  LoopTiming,
  PlantResponse,
  RecordedDelays,
  ScoredRollout,
  Steering,
  VelocityResponse,
  VelocityResponses
}
import skein.policy.*
import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.simd.WorldRandom
import skein.units.Span
import skein.vehicle.{ConstantTurn, ReducedModel, PlantModel}

class PairBatchSimulation extends munit.FunSuite:
  import PairBatchSimulation.*

  private val short = Pair.paper.copy(durationS = 12)

  test("threads, the other worlds and their order change no bit"):
    val all    = PairBatch(short, LoopTiming.Stream(), lag, threads = 2).fly(mixed(300), captureRadiusM = 5)
    val single = PairBatch(short, LoopTiming.Stream(), lag, threads = 1)
    val backwards = single.fly(reordered(mixed(300), 299 - _), captureRadiusM = 5)
    assertEquals(all.flown, 300)
    for world <- 0 until 300 do
      assertEquals(numbers(backwards, 299 - world), numbers(all, world), s"world $world")

  test("worlds whose policies are not formulas use the scalar reference, even among worlds that use SIMD"):
    val worlds   = mixed(40)
    val outcomes = PairBatch(short, LoopTiming.Stream(), lag).fly(worlds, captureRadiusM = 5)
    for world <- 0 until worlds.size if worlds.evader(world) == Straight do
      assertEquals(numbers(outcomes, world), scalar(worlds, world, LoopTiming.Stream(), lag), s"world $world")

  for model <- Seq(lag, PlantResponse(Bicycle(1.2, 0.3, 4, 0.4))) do
    test(
      s"$model, predicted with a model without SIMD support, uses the scalar reference, and says so"
    ):
      val timing = LoopTiming.Predictive(predictor = ConstantTurn)
      val batch  = PairBatch(short, timing, model, threads = 2)
      val worlds = mixed(20)
      val flown  = batch.fly(worlds, captureRadiusM = 5)
      assert(batch.engine(PaperPursuer(), PaperEvader(), false, Nil).text.startsWith("scalar: "))
      assert(!batch.engine(PaperPursuer(), PaperEvader(), false, Nil).isFast)
      for world <- 0 until worlds.size do
        assertEquals(numbers(flown, world), scalar(worlds, world, timing, model), s"world $world")

  test(
    "over recorded delays, and if vehicles are read as published, the engine is scalar and states why; " +
      "long and changing delays are supported with SIMD"
  ):
    val near                      = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(2)))
    val far                       = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(60)))
    def batch(timing: LoopTiming) = PairBatch(short, timing, lag, threads = 1)
    def engine(timing: LoopTiming, links: Delays*) =
      batch(timing).engine(PaperPursuer(), PaperEvader(), shareEpisodes = false, links).text
    def isFast(timing: LoopTiming, links: Delays*) =
      batch(timing).engine(PaperPursuer(), PaperEvader(), shareEpisodes = false, links).isFast
    assert(isFast(LoopTiming.stream(0.1), near, far))
    val slow = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(8000)))
    assert(isFast(LoopTiming.stream(0.005), near, far))
    assert(isFast(LoopTiming.Stream(decideThenPace = true), near, far))
    assert(clue(engine(
      LoopTiming.stream(0.01),
      near,
      slow
    )).contains("over 1 of 2 links; scalar over the others: a command"))
    assert(!isFast(LoopTiming.stream(0.01), near, slow))
    val alternating = LinkDelays.of(LatencyProfile.vpnMixed)
    assert(isFast(LoopTiming.stream(0.1), alternating, near))
    val recorded = RecordedDelays(Vector.fill(2)(Vector.fill(4)(Array(1L))))
    assert(clue(engine(LoopTiming.stream(0.1), recorded)).startsWith("scalar: "))
    assert(batch(LoopTiming.stream(0.1)).engine(
      PaperPursuer(),
      PaperEvader(),
      shareEpisodes = true,
      Seq(recorded)
    ).isFast)
    for published <- Seq(
        LoopTiming.Predictive(predictor = lag.predictor, asking = Asking(inOrder = true)),
        LoopTiming.Stream(asking = Asking(inOrder = true)),
        LoopTiming.Stream(asking = Asking(spreadS = 0.1))
      )
    do assert(clue(engine(published, near)).startsWith("scalar: SIMD "))
    def most(moves: Int) = LoopTiming.Stream(steering = Steering(mostOutstanding = moves))
    assert(clue(engine(most(1), near)).startsWith("scalar: with 1 move in flight"))
    assert(clue(engine(most(6), near)).startsWith("SIMD"))

  test("progress counts all worlds, and a cancelled call reports how many it simulated"):
    val batch = PairBatch(short, LoopTiming.Stream(), lag, threads = 2)
    val seen  = Vector.newBuilder[Int]
    batch.fly(mixed(600), onProgress = seen += _): Unit
    assertEquals(seen.result().last, 600)
    assertEquals(seen.result(), seen.result().sorted)
    val done   = AtomicInteger()
    val worlds = mixed(600)
    val part   = batch.fly(worlds, onProgress = done.set, isCancelled = () => done.get > 0)
    assert(part.flown > 0 && part.flown < 600, s"${part.flown} flown")
    val whole = batch.fly(worlds)
    val same  = (0 until 600).count(world => numbers(part, world) == numbers(whole, world))
    assertEquals(same, part.flown)

  test("a cancelled call does not wait long for vehicles that are stepped together"):
    val hours = Pair.paper.copy(durationS = 36_000)
    val batch = PairBatch(hours, LoopTiming.Stream(), VelocityResponses.quadrotor(), threads = 1)
    val asked = AtomicInteger()
    // Polled once before the batch, and then during it.
    assertEquals(batch.fly(mixed(8), isCancelled = () => asked.incrementAndGet() > 1).flown, 0)

  for timing <-
      Seq(LoopTiming.Stream(), LoopTiming.Futures(), LoopTiming.Predictive(predictor = lag.predictor))
  do
    test(
      s"candidates that share episodes of $timing fly as each alone, whatever their order, number and threads"
    ):
      val batch     = PairBatch(short, timing, lag, threads = 2)
      val worlds    = candidates(150)
      val all       = batch.fly(worlds, captureRadiusM = 5)
      val backwards = PairBatch(short, timing, lag, threads = 1)
        .fly(reordered(worlds, worlds.size - 1 - _), captureRadiusM = 5)
      assertEquals(all.flown, worlds.size)
      assert(batch.engine(PaperPursuer(), PaperEvader(), shareEpisodes = true, Nil).isFast)
      for world <- 0 until worlds.size do
        assertEquals(numbers(backwards, worlds.size - 1 - world), numbers(all, world), s"world $world")
      for world <- 0 until worlds.size by 29 do
        val alone = batch.fly(reordered(worlds, _ => world, Some(1)), captureRadiusM = 5)
        assertEquals(numbers(alone, 0), numbers(all, world), s"world $world")
        for (ours, reference) <- numbers(all, world).zip(scalar(worlds, world, timing, lag)) do
          assert(
            ours == reference || (ours - reference).abs < 5e-3,
            s"world $world: $ours, scalar $reference"
          )

  for (name, model) <- Seq(
      "the quadrotor" -> VelocityResponses.quadrotor(),
      "drag"          -> PlantResponse(ReducedModel.AirSim)
    )
  do
    test(
      s"candidates with $name that share episodes have with SIMD the results of each alone, close to the scalar engine"
    ):
      val offAxis = Pair(short.pursuer, short.evader.copy(startY = 2), short.durationS)
      val batch   = PairBatch(offAxis, LoopTiming.Futures(), model, threads = 2)
      val worlds  = candidates(30)
      assert(batch.engine(PaperPursuer(), PaperEvader(), shareEpisodes = true, Nil).isFast)
      val all       = batch.fly(worlds, captureRadiusM = 5)
      val backwards = batch.fly(reordered(worlds, worlds.size - 1 - _), captureRadiusM = 5)
      for world <- 0 until worlds.size do
        assertEquals(numbers(backwards, worlds.size - 1 - world), numbers(all, world), s"world $world")
      for world <- 0 until worlds.size by 17 do
        val alone = batch.fly(reordered(worlds, _ => world, Some(1)), captureRadiusM = 5)
        assertEquals(numbers(alone, 0), numbers(all, world), s"world $world")
        val near = numbers(all, world).zip(scalar(worlds, world, LoopTiming.Futures(), model, offAxis))
        assert(near.forall((a, b) => a == b || (a - b).abs < 2e-2), s"world $world: ours and scalar $near")

  private val foreseen = LoopTiming.Predictive(predictor = PlantModel(ReducedModel.AirSim))

  for timing <- Seq(LoopTiming.Stream(), LoopTiming.Sequential(), foreseen) do
    test(s"quadrotors with separate delays under $timing have results close to the scalar engine"):
      val (model, count) = (VelocityResponses.quadrotor(), 150)
      val offAxis        = Pair(short.pursuer, short.evader.copy(startY = 2), short.durationS)
      val all = PairBatch(offAxis, timing, model, threads = 2).fly(mixed(count), captureRadiusM = 5)
      assert(PairBatch(offAxis, timing, model).engine(PaperPursuer(), Straight, false, Nil).isFast)
      val single    = PairBatch(offAxis, timing, model, threads = 1)
      val backwards = single.fly(reordered(mixed(count), count - 1 - _), captureRadiusM = 5)
      assertEquals(all.flown, count)
      for world <- 0 until count do
        assertEquals(numbers(backwards, count - 1 - world), numbers(all, world), s"world $world")
      for world <- 0 until count by 5 do
        val near = numbers(all, world).zip(scalar(mixed(count), world, timing, model, offAxis))
        assert(near.forall((a, b) => a == b || (a - b).abs < 2e-2), s"world $world: ours and scalar $near")

  test("low quadrotors use the scalar reference, which includes the ground"):
    val batch = PairBatch(Pair.at(4.9, 12), LoopTiming.Stream(), VelocityResponses.quadrotor())
    assertEquals(
      batch.engine(PaperPursuer(), PaperEvader(), shareEpisodes = true, Nil).text,
      "scalar: SIMD simulates no ground: vehicles must start at 5.0 m altitude or higher"
    )

  test("an exception thrown by a world reaches the caller"):
    val worlds = mixed(300)
    val broken = new PairWorlds:
      export worlds.{evader, key, pursuer, size}
      def link(world: Int): Delays =
        if world == 200 then sys.error("no such link") else worlds.link(world)
    val thrown = intercept[RuntimeException](PairBatch(short, LoopTiming.Stream(), lag).fly(broken): Unit)
    assertEquals(thrown.getMessage, "no such link")

  test("without the vector module the scalar engine is used, and states how to get SIMD"):
    val binary  = java.nio.file.Path.of(System.getProperty("java.home"), "bin", "java").toString
    val process = ProcessBuilder(
      binary,
      "-cp",
      System.getProperty("java.class.path"),
      "skein.lanes.PairBatchWithoutVectors"
    ).redirectErrorStream(true).start()
    val lines = process.inputReader.lines.iterator.asScala.toVector
    assertEquals(process.waitFor(), 0, lines.mkString("\n"))
    assertEquals(
      lines.head,
      "scalar: the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector"
    )
    val here = scalar(mixed(1), 0, LoopTiming.Stream(), lag)
    assertEquals(lines(1), here.toString)

object PairBatchSimulation:
  /** Goes straight on, by a method that is not arithmetic. */
  val Straight: HeadingPolicy.Memoryless = _.ownHeadingRad.toString.toDouble

  val lag: PlantResponse = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  /** Worlds of different links and policies; the evader of every seventh goes straight on. */
  def mixed(count: Int): PairWorlds =
    val links = Vector(DelayTable.vpn, DelayTable.direct, DelayTable.none)
    new PairWorlds:
      def size: Int                    = count
      def key(world: Int): Int         = WorldRandom.key(7, 1, world)
      def link(world: Int): DelayTable = links(world / 10 % links.size)
      def pursuer(world: Int): Policy  = PaperPursuer(0.8 + 0.001 * world)
      def evader(world: Int): Policy   =
        if world % 7 == 6 then Straight else PaperEvader(8 - 0.002 * world)

  /** Candidates with 3 episodes over 2 links; the evader of every seventh goes straight on. */
  def candidates(count: Int): PairWorlds =
    val links = Vector(DelayTable.vpn, DelayTable.direct)
    new PairWorlds:
      def size: Int                       = count * 6
      override def shareEpisodes: Boolean = true
      def key(world: Int): Int            = WorldRandom.key(9, 0, world % 3)
      def link(world: Int): DelayTable    = links(world % 6 / 3)
      def pursuer(world: Int): Policy     =
        if world / 6 % 5 == 0 then PaperPursuer(stepRad = Some(0.1))
        else PaperPursuer(0.8 + 0.002 * (world / 6))
      def evader(world: Int): Policy = if world % 7 == 6 then Straight else PaperEvader()

  def reordered(worlds: PairWorlds, number: Int => Int, count: Option[Int] = None): PairWorlds =
    new PairWorlds:
      def size: Int                       = count.getOrElse(worlds.size)
      override def shareEpisodes: Boolean = worlds.shareEpisodes
      def key(world: Int): Int            = worlds.key(number(world))
      def link(world: Int): Delays        = worlds.link(number(world))
      def pursuer(world: Int): Policy     = worlds.pursuer(number(world))
      def evader(world: Int): Policy      = worlds.evader(number(world))

  def numbers(o: PairOutcomes, world: Int): Vector[Float] =
    Vector(
      o.minDistanceM,
      o.meanDistanceM,
      o.meanLast10sM,
      o.captureS,
      o.pursuerEffortRad,
      o.evaderEffortRad
    ).map(_(world))

  def scalar(
      worlds: PairWorlds,
      world: Int,
      timing: LoopTiming,
      model: VelocityResponse,
      from: Pair = Pair.paper
  ): Vector[Float] =
    val duel = Pair(
      from.pursuer.copy(policy = worlds.pursuer(world)),
      from.evader.copy(policy = worlds.evader(world)),
      12
    )
    val o = ScoredRollout(duel.engagement, timing, worlds.link(world), model).fly(worlds.key(world), 5)
    Vector(o.minDistanceM, o.meanDistanceM, o.meanLast10sM, o.captureS, o.pursuerEffortRad, o.evaderEffortRad)
      .map(_.toFloat)

/** Runs in a JVM without the vector module. */
object PairBatchWithoutVectors:
  def main(args: Array[String]): Unit =
    val batch =
      PairBatch(Pair.paper.copy(durationS = 12), LoopTiming.Stream(), PairBatchSimulation.lag, threads = 1)
    println(batch.engine(PaperPursuer(), PaperEvader(), false, Nil).text)
    println(PairBatchSimulation.numbers(batch.fly(PairBatchSimulation.mixed(1), captureRadiusM = 5), 0))
