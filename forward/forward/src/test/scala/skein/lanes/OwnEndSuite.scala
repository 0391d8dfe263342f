package skein.lanes

import skein.forward.*
import skein.lanes.score.{Judged, OfMoment}
import skein.optimise.ScenarioTerm
import skein.policy.*
import skein.scenario.*
import skein.signal.{LatencyDistribution, SplitMix64}
import skein.simd.WorldRandom
import skein.testing.Optimised
import skein.units.*
import skein.vehicle.TiltModel

/** Compares SIMD with the scalar reference, for scenarios that end by themselves. */
class OwnEndSuite extends munit.FunSuite, Optimised:
  import OwnEndSuite.*

  private val durationS = 12.0

  private val judged = Vector(
    Judged(Height, Reduction.Least, 0),
    Judged(Height, Reduction.Most, 0),
    Judged(Apart, Reduction.Mean, 0),
    Judged(Apart, Reduction.Sd, 0),
    Judged(Apart, Reduction.Rms, 1),
    Judged(Apart, OfMoment.Newest, 0),
    Judged(Apart, OfMoment.FirstWithin(8), 0),
    // Most worlds end before these begin: then all of the flight counts.
    Judged(Apart, Reduction.Least, 9),
    Judged(Ahead, Reduction.Sd, 9),
    Judged(Ahead, Reduction.Most, 6)
  ) ++ Vector(
    Series.of("ahead", "m", Ahead).leastAt("at"),
    Series.of("height", "m", Height).mostAt("at", Window.After(9)),
    apart.timeAbove("far", 8.1),
    apart.timeBelow("near", 9.7, Window.After(2)),
    apart.firstAbove("from", 9.3),
    apart.firstBelow("from", 7.9),
    apart.staysAbove("since", 8.3),
    apart.staysBelow("since", 20.1)
  ).map(ScenarioTerm(_).judged(durationS, 0.1).head)

  private def apart = Series.of("apart", "m", Apart)

  private def candidates(scenarios: SplitMix64 => Scenario): Vector[TeamCandidate] =
    val random = SplitMix64(11)
    Vector.fill(20)(TeamCandidate(Engagement.ofScenario(scenarios(random), durationS), judged))

  private def flown(
      candidates: Vector[TeamCandidate],
      timing: LoopTiming,
      model: VelocityResponse,
      shared: Boolean,
      isReference: Boolean,
      over: Delays = DelayTable.vpn
  ): Vector[Array[Float]] =
    val batch  = TeamBatch(timing, model, threads = 1, isReference = isReference)
    val engine = batch.engine(candidates.head, shared, Seq(over))
    assertEquals(engine.fliesByLanes, !isReference, engine.text)
    batch.fly(new TeamWorlds:
      def size: Int                            = 2 * candidates.size
      override def shareEpisodes: Boolean      = shared
      def key(world: Int): Int                 = WorldRandom.key(5, 0, if shared then world % 2 else world)
      def link(world: Int): Delays             = over
      def candidate(world: Int): TeamCandidate = candidates(world / 2)).values

  private def within(random: SplitMix64, least: Double, most: Double) =
    least + (most - least) * random.nextDouble()

  private val level   = VelocityResponses.lag(gain = 0.95, lagS = 0.6, deadTimeS = 0.02)
  private val inSpace = SpatialResponse(TiltModel.AirSim)

  private val ends: Seq[(String, VelocityResponse, SplitMix64 => Scenario)] = Seq(
    ("by a place", level, random => ByPlace(within(random, 10, 50))),
    ("by altitudes of level flight, and speed", level, random => BySpeed(within(random, 1, 6))),
    (ByTime.Name, level, random => ByTime(within(random, 2, 15))),
    (ByAge.Name, level, random => ByAge(within(random, 0.05, 0.3))),
    (
      "from a file, by a place and ages",
      level,
      random => fromFile(within(random, 10, 50), within(random, 0, 0.15))
    ),
    ("by height and climb", inSpace, random => ByClimb(within(random, 13, 22)))
  )

  for
    (name, model, scenarios) <- ends
    // Those that tell most apart fly in every loop.
    timing <-
      if Vector(ByAge.Name, ByTime.Name).contains(name) then
        TestLoops.unpredicted :+ LoopTiming.Predictive(predictor = level.predictor)
      else Seq(LoopTiming.Stream())
    shared <- Seq(true, false)
    if shared || timing != LoopTiming.Paused()
  do
    val delays = if shared then "shared" else "own"
    test(s"an end $name, $timing, $delays delays: scores with SIMD are those of the scalar engine"):
      val all          = candidates(scenarios)
      val (fast, slow) = (flown(all, timing, model, shared, false), flown(all, timing, model, shared, true))
      for number <- fast.indices; world <- slow(0).indices do
        val (value, expected) = (fast(number)(world).toDouble, slow(number)(world).toDouble)
        if expected.isNaN then assert(value.isNaN, s"number $number, world $world: $value")
        else assertEqualsDouble(value, expected, 4e-3, s"number $number, world $world")
      // Worlds end at different times, and some before the last score counts.
      assert(slow(2).distinct.length > 5, slow(2).mkString(", "))
      assertEquals(slow(7).count(_.isNaN), slow(0).count(_.isNaN), slow(7).mkString(", "))

  for timing <- Seq(LoopTiming.Predictive(predictor = level.predictor), LoopTiming.Futures()) do
    test(s"${timing.productPrefix}, own delays: what is over from the beginning ends at its first decision"):
      // Some begin beyond the place where they end.
      val all          = candidates(random => ByPlace(within(random, -5, 45)))
      val far          = DelayTable.of(LatencyDistribution.Uniform(Span.ofMillis(60), Span.ofMillis(100)))
      val (fast, slow) =
        (flown(all, timing, level, false, false, far), flown(all, timing, level, false, true, far))
      for number <- fast.indices; world <- slow(0).indices do
        val (value, expected) = (fast(number)(world).toDouble, slow(number)(world).toDouble)
        assert(value.isNaN == expected.isNaN, s"number $number, world $world: $value, scalar $expected")
        if !expected.isNaN then assertEqualsDouble(value, expected, 4e-3, s"number $number, world $world")

  test("an end that is not a formula is refused with its line"):
    val all    = Vector.fill(2)(TeamCandidate(Engagement.ofScenario(ByList(3), durationS), judged))
    val engine = TeamBatch(LoopTiming.Stream(), level).engine(all.head, true, Seq(DelayTable.vpn))
    assert(engine.text.contains("its end is no formula"), engine.text)
    assert(engine.text.contains("OwnEndSuite.scala:"), engine.text)

object OwnEndSuite:
  private val Text =
    """skein-scenario 1
      |name two
      |setting far-m 20 "north at which it ends, m"
      |setting old-s 1 "age from which it may end, s"
      |0 setting far-m
      |1 setting old-s
      |2 const 0.0
      |3 const 5.0
      |4 const -20.0
      |5 north 0
      |6 age 1
      |7 lt 0 5
      |8 lt 1 6
      |9 and 7 8
      |10 start-down
      |11 const 1.0
      |vehicle V0 Scout 3 2 2 4 2
      |does along 2 3 10
      |vehicle V1 Scout 3 3 3 4 2
      |does along 11 3 10
      |over 9
      |""".stripMargin

  private val file =
    ScenarioText.read(Text).fold(mistake => throw IllegalArgumentException(mistake), identity)

  private def fromFile(farM: Double, oldS: Double): Scenario =
    file.read(Map("far-m" -> farM.toString, "old-s" -> oldS.toString)).fold(
      mistakes => throw IllegalArgumentException(mistakes.mkString("; ")),
      identity
    )

  private def agent(i: Int, policy: Policy) =
    Agent(
      s"V$i",
      Role("Scout"),
      MetresPerSecond(4 + i),
      Vector3(6 * i, 5 * i, -14 - i),
      Radians(0.3 * i),
      policy
    )

  sealed private trait OfThree extends Scenario:
    def agents: Vector[Agent] =
      Vector(agent(0, Turning(0.1)), agent(1, Turning(-0.2)), agent(2, Turning(0.05)))

  /** Turns steadily. */
  private final case class Turning(rate: Double) extends Policy:
    type Memory = Double
    def start: Double                                               = 0
    def choose(seen: Observation, memory: Double): (Action, Double) =
      val angle = memory + rate * seen.elapsed.toSeconds
      (Action.Along(Radians(angle), seen.cruise, seen.startDown), angle)

  private final case class ByPlace(northM: Double) extends OfThree:
    override def isOver(known: Known): Boolean = known.vehicles.exists(_.kinematics.positionNed.x > northM)

  private final case class BySpeed(mps: Double) extends OfThree:
    override def isOver(known: Known): Boolean =
      val first = known.vehicles.head.kinematics
      first.positionNed.z + first.velocityNed.z < -13 && first.velocityNed.y > mps / 2

  private final case class ByTime(seconds: Double) extends OfThree:
    override def isOver(known: Known): Boolean = known.elapsed > Span.ofSeconds(seconds)

  private final case class ByAge(seconds: Double) extends OfThree:
    override def isOver(known: Known): Boolean =
      0.2 * known.vehicles.map(_.age.toSeconds).sum + known.vehicles(
        1
      ).kinematics.positionNed.x / 200 > seconds

  private object ByTime:
    val Name = "by the time"

  private object ByAge:
    val Name = "by ages of readings"

  private final case class ByClimb(altitudeM: Double) extends Scenario:
    def agents: Vector[Agent]                  = Vector(agent(0, Climbing), agent(1, Turning(0.1)))
    override def isOver(known: Known): Boolean =
      val first = known.vehicles.head.kinematics
      -first.positionNed.z - first.velocityNed.z > altitudeM

  private case object Climbing extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      (
        Action.Velocity(Vector3(2, 1, -0.2 * seen.vehicles(1).kinematics.positionNed.x.min(8)), Yaw.Forward),
        ()
      )

  private final case class ByList(seconds: Double) extends OfThree:
    override def isOver(known: Known): Boolean =
      val sorted = known.vehicles.map(_.kinematics.positionNed.x).sorted
      sorted.head > seconds

  private case object Height extends Quantity:
    def of(at: Positions): Double = (0 until at.count).map(at.downM(_)).min

  private case object Apart extends Quantity:
    def of(at: Positions): Double = at.distanceM(0, 1)

  /** How far the first vehicle is from a point that moves, m. */
  private case object Ahead extends Quantity:
    def of(at: Positions): Double = at.distanceM(0, 2 * at.elapsedS, 10)
