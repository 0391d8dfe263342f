package skein.rollout

import skein.policy.*
import skein.signal.SplitMix64

class LanePolicySuite extends munit.FunSuite:
  private val worlds  = LanePolicy.WORLDS
  private val network = NeuralShape.parse("8x8").toOption.get

  private val families: Seq[(String, SplitMix64 => Policy)] =
    PolicyFamily.all.filter(_ != PolicyFamily.chauffeurPursuer).map(family =>
      family.name -> drawn(family)
    ) ++ Seq(
      "paper-pursuer as published" -> (_ => PaperPursuer.asPublished),
      "neural:8x8"                 -> drawn(PolicyFamily.neural(network))
    )

  private def drawn(family: PolicyFamily)(random: SplitMix64): Policy =
    family.policy(family.space.at(Vector.fill(family.space.dimension)(random.nextDouble())))

  // In few worlds a rounding error decides between two ways.
  for (name, draw) <- families do
    test(s"$name decides by lanes as the scalar policy does"):
      val random         = SplitMix64(11)
      val (sight, lanes) = (LaneSight(), LanePolicy.of(draw(random)))
      val (own, known)   = (Directions(worlds), Directions(worlds))
      val into           = Directions(worlds)
      var off            = Vector.empty[Double]
      for _ <- 1 to 8 do
        def uniform(most: Double) = most * (2 * random.nextDouble() - 1)
        val policies              = Vector.fill(worlds)(draw(random))
        val ownHeading            = uniform(3)
        val knownHeadings         = Vector.fill(worlds)(uniform(10))
        for (policy, world) <- policies.zipWithIndex do
          lanes.take(world, policy)
          sight.dx(world) = uniform(25).toFloat; sight.dy(world) = uniform(25).toFloat
          sight.dvx(world) = uniform(12).toFloat; sight.dvy(world) = uniform(12).toFloat
          sight.elapsed(world) = (0.1 * random.nextDouble()).toFloat
          known.fill(world, world + 1, knownHeadings(world))
        own.fill(0, worlds, ownHeading)
        lanes.start(ownHeading.toFloat)
        lanes.decide(sight, own, 0, known, 0, into, 0)
        off = off ++ policies.zipWithIndex.map: (policy, world) =>
          val heading = policy.heading(
            sight.dx(world),
            sight.dy(world),
            sight.dvx(world),
            sight.dvy(world),
            ownHeading,
            knownHeadings(world),
            sight.elapsed(world)
          )
          val apart  = math.hypot(into.cos(world) - math.cos(heading), into.sin(world) - math.sin(heading))
          val turned = math.abs(math.IEEEremainder(heading - ownHeading, 2 * math.Pi))
          apart max math.abs(lanes.turned(world) - turned)
      assert(off.count(_ < 1e-3) >= 0.995 * off.size, off.sorted.takeRight(20).mkString(" "))
      assert(off.sorted.apply(off.size / 2) < 1e-5, off.sorted.apply(off.size / 2))

  test("a policy that no lanes know has none"):
    for policy <- Seq(KeepHeading, ChauffeurPursuer()) do
      assertEquals(LanePolicy.of(policy), null)
      assertEquals(LanePolicy.formOf(policy), null)

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
      assert(batch.fliesByLanes(pursuers.head, opponent, all.shareEpisodes))
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
