package skein.lanes

import skein.forward.{DelayTable, Pair, LoopTiming, VelocityResponses}
import skein.lanes.policy.{Directions, LaneObservation, LanePolicy, PolicyLanes}
import skein.policy.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom

class LanePolicySimulation extends munit.FunSuite:
  private val worlds = LanePolicy.WORLDS

  private val families: Seq[(String, SplitMix64 => HeadingPolicy)] =
    (PolicyFamily.all ++ Seq("8x8", "16x16", "32x5x16").map(shape =>
      PolicyFamily.parse(s"neural:$shape").toOption.get
    ))
      .map(family => family.name -> drawn(family)) ++ Seq[(String, SplitMix64 => HeadingPolicy)](
      "paper-pursuer as published" -> (_ => PaperPursuer.asPublished),
      "keep-heading"               -> (_ => KeepHeading)
    )

  private def drawn(family: PolicyFamily)(random: SplitMix64): HeadingPolicy =
    family.policy(
      family.space.at(Vector.fill(family.space.dimension)(random.nextDouble()))
    ).asInstanceOf[HeadingPolicy]

  for (name, draw) <- families do
    test(s"$name decides with SIMD like the scalar policy"):
      val random             = SplitMix64(11)
      val (observation, own) = (LaneObservation(), Directions(worlds))
      val (known, into)      = (Directions(worlds), Directions(worlds))
      val lanes              = LoggedPolicy(draw(random))
      val read               = Vector.fill(LaneObservation.READ)(Array.ofDim[Float](worlds))
      for (numbers, what) <- read.zipWithIndex do observation.seeFromOwn(what, numbers)
      for round <- 1 to 4 do
        def uniform(most: Double) = most * (2 * random.nextDouble() - 1)
        val agreement             = Agreement()
        val policies              = Vector.fill(worlds)(draw(random))
        val ownHeading            = uniform(3)
        val knownHeadings         = Vector.fill(worlds)(uniform(10))
        for (policy, world) <- policies.zipWithIndex do
          LanePolicies.take(lanes)(world, policy)
          for (numbers, most) <- read.zip(Seq(25, 25, 12, 12)) do numbers(world) = uniform(most).toFloat
          observation.elapsed(world) = (0.1 * random.nextDouble()).toFloat
          known.fill(world, world + 1, knownHeadings(world))
        own.fill(0, worlds, ownHeading)
        lanes.start(ownHeading.toFloat, LanePolicy.WORLDS)
        lanes.decide(observation, own, 0, known, 0, into, 0)
        for (policy, world) <- policies.zipWithIndex do
          val seen = PlanarObservation(
            read(0)(world),
            read(1)(world),
            read(2)(world),
            read(3)(world),
            ownHeading,
            knownHeadings(world),
            observation.elapsed(world),
            0,
            0
          )
          val memory    = policy.start
          val departure = PairAgreement.departure(0, 0, 0, policy, seen, memory, lanes.made.last, world)
          agreement.add(world, departure):
            // The formula is the policy.
            val heading = policy.decide(seen, memory)._1
            assertEqualsDouble(into.cos(world), math.cos(heading), 1e-4)
            assertEqualsDouble(into.sin(world), math.sin(heading), 1e-4)
            val turned = math.abs(math.IEEEremainder(heading - ownHeading, 2 * math.Pi))
            assertEqualsDouble(lanes.turned(world), turned, 1e-3)
        agreement.check(s"seed 11, round $round", atLeast = worlds / 2)

  test("the refusal of one policy does not refuse another of its class"):
    assert(PolicyLanes.of(Hasty(true)).isLeft)
    assert(PolicyLanes.of(Hasty(false)).isRight)
    assert(PolicyLanes.of(Hasty(true)).isLeft)

  test("a policy that is not a formula is refused with the reason and the line"):
    val refused = PolicyLanes.of(Impatient()).fold(_.getMessage, _ => fail("it was compiled"))
    assert(refused.contains("LanePolicySimulation.scala"), refused)
    assert(refused.contains("System.nanoTime"), refused)

  for
    (name, draw)     <- families if name != "paper-evader" && name != "chauffeur-evader"
    (timing, shared) <- Seq(
      LoopTiming.Stream()  -> false,
      LoopTiming.Futures() -> true,
      LoopTiming.Stream()  -> true
    )
  do
    val many = if shared then "candidates of an episode" else "worlds with delays of their own"
    // The paper's pursuer turns to either side of an evader straight ahead, as a rounding error decides.
    val opponent = if name.startsWith("paper") then PaperEvader() else ChauffeurEvader()
    test(s"$name against $opponent, ${timing.productPrefix}, $many: SIMD equals the scalar reference"):
      val random   = SplitMix64(5)
      val pursuers = Vector.fill(worlds)(draw(random))
      val model    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
      // Straight ahead rounding would decide to which side the two turn.
      val short           = Pair.paper.copy(evader = Pair.paper.evader.copy(startY = 2), durationS = 5)
      def key(world: Int) = WorldRandom.key(1, 0, world)
      val agreement       =
        if shared then PairAgreement.shared(short, timing, model, DelayTable.vpn, key(0))
        else PairAgreement.alone(short, timing, model, _ => DelayTable.vpn, key)
      agreement(pursuers, _ => opponent).check("seed 5", 0 until worlds by 3)

/** A policy of another form, or no formula, depending on `isHasty`. */
private final case class Hasty(isHasty: Boolean) extends HeadingPolicy.Memoryless:
  def heading(seen: PlanarObservation): Double =
    import seen.*
    if isHasty && System.nanoTime > 0 then dxM else dyM

private final class Impatient extends HeadingPolicy.Memoryless:
  def heading(seen: PlanarObservation): Double =
    import seen.*
    if System.nanoTime > 0 then dxM else dyM
