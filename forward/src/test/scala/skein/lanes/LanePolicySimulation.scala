package skein.lanes

import skein.forward.{DelayTable, Delays, Duel, LoopTiming, Reduced, Rollout}
import skein.policy.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom

class LanePolicySimulation extends munit.FunSuite:
  private val worlds = LanePolicy.WORLDS

  private val families: Seq[(String, SplitMix64 => Policy)] =
    (PolicyFamily.all ++ Seq("8x8", "16x16", "32x5x16").map(shape =>
      PolicyFamily.parse(s"neural:$shape").toOption.get
    ))
      .map(family => family.name -> drawn(family)) ++ Seq[(String, SplitMix64 => Policy)](
      "paper-pursuer as published" -> (_ => PaperPursuer.asPublished),
      "keep-heading"               -> (_ => KeepHeading)
    )

  private def drawn(family: PolicyFamily)(random: SplitMix64): Policy =
    family.policy(family.space.at(Vector.fill(family.space.dimension)(random.nextDouble())))

  // In few worlds a rounding error decides between two ways.
  for (name, draw) <- families do
    test(s"$name decides by lanes as the scalar policy does"):
      val random               = SplitMix64(11)
      val (observation, lanes) = (LaneObservation(), LanePolicy.of(draw(random)))
      val (own, known)         = (Directions(worlds), Directions(worlds))
      val into                 = Directions(worlds)
      val read                 = Vector.fill(LaneObservation.READ)(Array.ofDim[Float](worlds))
      for (numbers, what) <- read.zipWithIndex do observation.seeFromOwn(what, numbers)
      var off = Vector.empty[Double]
      for _ <- 1 to 8 do
        def uniform(most: Double) = most * (2 * random.nextDouble() - 1)
        val policies              = Vector.fill(worlds)(draw(random))
        val ownHeading            = uniform(3)
        val knownHeadings         = Vector.fill(worlds)(uniform(10))
        for (policy, world) <- policies.zipWithIndex do
          lanes.take(world, policy)
          for (numbers, most) <- read.zip(Seq(25, 25, 12, 12)) do numbers(world) = uniform(most).toFloat
          observation.elapsed(world) = (0.1 * random.nextDouble()).toFloat
          known.fill(world, world + 1, knownHeadings(world))
        own.fill(0, worlds, ownHeading)
        lanes.start(ownHeading.toFloat)
        lanes.decide(observation, own, 0, known, 0, into, 0)
        off = off ++ policies.zipWithIndex.map: (policy, world) =>
          val heading = policy.heading(
            read(0)(world),
            read(1)(world),
            read(2)(world),
            read(3)(world),
            ownHeading,
            knownHeadings(world),
            observation.elapsed(world)
          )
          val apart  = math.hypot(into.cos(world) - math.cos(heading), into.sin(world) - math.sin(heading))
          val turned = math.abs(math.IEEEremainder(heading - ownHeading, 2 * math.Pi))
          apart max math.abs(lanes.turned(world) - turned)
      assert(off.count(_ < 1e-3) >= 0.995 * off.size, off.sorted.takeRight(20).mkString(" "))
      assert(off.sorted.apply(off.size / 2) < 1e-5, off.sorted.apply(off.size / 2))

  test("a policy that is no formula says why, and where"):
    val refused = PolicyLanes.of(Impatient()).fold(_.getMessage, _ => fail("it was compiled"))
    assert(refused.contains("LanePolicySimulation.scala"), refused)
    assert(refused.contains("System.nanoTime"), refused)

  for
    (name, draw)       <- families if name != "paper-evader" && name != "chauffeur-evader"
    (timing, episodes) <- Seq(LoopTiming.Stream() -> 1, LoopTiming.Futures() -> 16, LoopTiming.Stream() -> 16)
  do
    val many = if episodes > 1 then "candidates of an episode" else "worlds with delays of their own"
    // The paper's pursuer turns to either side of an evader straight ahead, as a rounding error decides.
    val opponent = if name.startsWith("paper") then PaperEvader() else ChauffeurEvader()
    test(s"$name against $opponent, ${timing.productPrefix}, $many: by lanes as by the scalar reference"):
      val random   = SplitMix64(5)
      val pursuers = Vector.fill(64)(draw(random))
      val all      = new DuelWorlds:
        def size: Int                       = pursuers.size
        override def shareEpisodes: Boolean = episodes > 1
        def key(world: Int): Int            = WorldRandom.key(1, 0, world / episodes)
        def link(world: Int): Delays        = DelayTable.vpn
        def pursuer(world: Int): Policy     = pursuers(world)
        def evader(world: Int): Policy      = opponent
      val model = Reduced(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
      val short = Duel.paper.copy(durationS = 5)
      val batch = DuelBatch(short, timing, model, 1)
      assert(batch.fliesByLanes(pursuers.head, opponent, all.shareEpisodes, Nil))
      val outcomes = batch.fly(all)
      val off      = pursuers.indices.map: world =>
        val duel = Duel(
          short.pursuer.copy(policy = pursuers(world)),
          short.evader.copy(policy = opponent),
          short.durationS
        )
        val scalar = Rollout(duel, timing, DelayTable.vpn, model).fly(all.key(world))
        (outcomes.meanDistanceM(world) - scalar.meanDistanceM).abs max
          (outcomes.minDistanceM(world) - scalar.minDistanceM).abs max
          (outcomes.pursuerEffortRad(world) - scalar.pursuerEffortRad).abs
      assert(off.count(_ < 5e-3) >= 0.9 * off.size, off.sorted.mkString(" "))

private final class Impatient extends Policy:
  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double = if System.nanoTime > 0 then dxM else dyM
