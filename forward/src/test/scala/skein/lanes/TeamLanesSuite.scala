package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.*
import skein.policy.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom

class TeamLanesSuite extends munit.FunSuite:
  private val worlds = TimetableKernel.WORLDS
  private val lag    = Reduced(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val links  = Seq("none" -> DelayTable.none, "vpn" -> DelayTable.vpn)

  private val loops = Seq(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true)
  )

  private def within(random: SplitMix64, least: Double, most: Double) =
    least + (most - least) * random.nextDouble()

  private val scenarios: Seq[(String, SplitMix64 => TeamScenario)] = Seq(
    "surround" -> (random =>
      TeamScenario.Surround(6, ringM = within(random, 5, 12), pursuerMps = within(random, 6, 12))
    ),
    "formation" -> (random =>
      TeamScenario.Formation(spacingM = within(random, 3, 6), leaderMps = within(random, 3, 6))
    )
  )

  /** Without the symmetry in which two pursuers are as near, and rounding decides who is the nearest. */
  private def engagement(scenario: TeamScenario, durationS: Double) =
    val all = Engagement.of(scenario.scenario, durationS)
    all.copy(agents =
      all.agents.zipWithIndex.map((agent, i) => agent.copy(startY = agent.startY + 0.3 * i * i))
    )

  /** Places of all vehicles at every score, by world. */
  private final class Places(count: Int) extends TimetableScores:
    val places: ArrayBuffer[Array[(Double, Double)]] = ArrayBuffer.empty
    def start(): Unit                                = places.clear()
    def finish(): Unit                               = ()
    def score(
        all: Array[TimetableAgents],
        pictures: Array[Int],
        picture: Int,
        isLast: Boolean,
        timeS: Float
    ): Unit =
      for vehicle <- 0 until count do
        val from = pictures(picture + vehicle) * worlds
        places += Array.tabulate(worlds): world =>
          (
            all(vehicle).vehicles.seenX(from + world).toDouble,
            all(vehicle).vehicles.seenY(from + world).toDouble
          )

  private def scalar(of: Engagement, timing: LoopTiming, link: Delays, model: VelocityResponse, key: Int) =
    val places = ArrayBuffer.empty[(Double, Double)]
    val noting = new LoopObserver:
      override def scored(timeS: Double, vehicle: Int, x: Double, y: Double): Unit = places += ((x, y))
    Rollout(of, timing, link, model).fly(key, observer = noting): Unit
    places

  for
    (name, draw)   <- scenarios
    timing         <- loops
    (linked, link) <- links
  do
    test(s"$name, $timing over $linked: every world flies as by the scalar reference, 10 s to 2 mm"):
      val random = SplitMix64(7)
      val all    = Vector.fill(worlds)(engagement(draw(random), 10))
      val key    = WorldRandom.key(3, 1, 0)
      val model  = TimetableModel.of(lag, all.head.agents).fold(fail(_), identity)
      val lanes  = TeamLanes.of(policies(all.head)).fold(throw _, identity)
      val count  = lanes.count
      val team   = TeamPictures(lanes)
      val agents =
        Array.tabulate[TeamAgents](count)(self => TeamAgents(self, all.head.agents(self), model, team))
      val places = Places(count)
      for (each, world) <- all.zipWithIndex do
        assert(lanes.fits(policies(each)))
        for (agent, self) <- agents.zipWithIndex do agent.take(world, each.agents(self))
      TimetableKernel(agents.map(identity[TimetableAgents]), places)
        .fly(Timetable.of(count, 10, timing, link, key, model), worlds)
      for world <- 0 until worlds by 5 do
        val truth = scalar(all(world), timing, link, lag, key)
        assertEquals(truth.size, places.places.size)
        val off = truth.indices.map: i =>
          val (x, y) = places.places(i)(world)
          math.hypot(x - truth(i)._1, y - truth(i)._2)
        assert(off.max < 2e-3, s"world $world: ${off.max} m at score ${off.indices.maxBy(off) / count}")

  private def policies(of: Engagement) = of.agents.map(_.policy.asInstanceOf[TeamPolicy])
