package skein.lanes

import skein.forward.*
import skein.lanes.score.Judged
import skein.policy.*
import skein.scenario.*
import skein.simd.WorldRandom
import skein.testing.Optimised
import skein.units.*
import skein.vehicle.{Deviation, SensorNoise, TiltModel}

/** Compares SIMD with the scalar reference, for teams in three dimensions. */
class SpaceLanesSuite extends munit.FunSuite, Optimised:
  import SpaceLanesSuite.*

  private val model      = SpatialResponse(TiltModel.AirSim)
  private val durationS  = 4.0
  private val candidates = Vector.tabulate(9): number =>
    TeamCandidate(
      Engagement.inSpace(Fleet(team(3 + 0.1 * number, 1 + 0.02 * number)), durationS),
      Vector(
        Judged(Height, Reduction.Least, 0),
        Judged(Height, Reduction.Mean, 2),
        Judged(Apart, Reduction.Least, 0)
      )
    )

  private val loops = Seq(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  private val noisy =
    SensorNoise.parse("position=0.2,velocity=0.1,drift=1/20s,dropout=5%,outage=0.5s/3s")
      .map(SensedResponse(model, _)).fold(fail(_), identity)

  private def flown(
      timing: LoopTiming,
      over: Delays,
      shared: Boolean,
      isReference: Boolean,
      model: VelocityResponse = model
  ) =
    val batch  = TeamBatch(timing, model, threads = 1, isReference = isReference)
    val engine = batch.engine(candidates.head, shared, Seq(over))
    assertEquals(engine.fliesByLanes, !isReference, engine.text)
    batch.fly(new TeamWorlds:
      def size: Int                            = candidates.size
      override def shareEpisodes: Boolean      = shared
      def key(world: Int): Int                 = WorldRandom.key(5, 0, if shared then 0 else world)
      def link(world: Int): Delays             = over
      def candidate(world: Int): TeamCandidate = candidates(world)).values

  for
    timing         <- loops
    (linked, link) <- Seq[(String, Delays)]("none" -> DelayTable.none, "vpn" -> DelayTable.vpn)
    shared         <- Seq(true, false)
    if shared || timing != LoopTiming.Paused()
  do
    val delays = if shared then "shared" else "own"
    test(
      s"${timing.productPrefix} over $linked, $delays delays: scores with SIMD are those of the scalar engine, to 5 mm"
    ):
      val (fast, slow) = (flown(timing, link, shared, false), flown(timing, link, shared, true))
      for number <- fast.indices; world <- candidates.indices do
        assertEqualsDouble(
          fast(number)(world).toDouble,
          slow(number)(world).toDouble,
          5e-3,
          s"number $number, world $world"
        )
      // Vehicles do climb, and differently in each world.
      assert(slow(0).max < -12 && slow(0).distinct.length > 4, slow(0).mkString(", "))

  for timing <- loops; shared <- Seq(true, false) do
    test(
      s"${timing.productPrefix} by readings with errors, ${if shared then "shared" else "own"} delays: " +
        "scores with SIMD are those of the scalar engine, to 5 mm"
    ):
      def of(isReference: Boolean, model: VelocityResponse) =
        flown(timing, DelayTable.vpn, shared, isReference, model)
      val (fast, slow) = (of(false, noisy), of(true, noisy))
      for number <- fast.indices; world <- candidates.indices do
        assertEqualsDouble(
          fast(number)(world).toDouble,
          slow(number)(world).toDouble,
          5e-3,
          s"number $number, world $world"
        )
      assertNotEquals(slow(1).toVector, of(true, model)(1).toVector)

  test("a policy that chooses between a velocity and an altitude by its observation is one formula"):
    val engine = TeamBatch(LoopTiming.Stream(), model).engine(candidates.head, true, Seq(DelayTable.vpn))
    assert(engine.fliesByLanes, engine.text)

  test("models of level flight refuse policies that climb, and give the reason"):
    val level  = TeamBatch(LoopTiming.Stream(), VelocityResponses.lag(1, 1, 0))
    val engine = level.engine(candidates.head, true, Seq(DelayTable.vpn))
    assert(engine.text.contains("it leaves the altitude of its vehicle's start"), engine.text)

  for shared <- Seq(true, false) do
    test(
      s"vehicles that deviate from the model that predicts them, ${if shared then "shared" else "own"} delays"
    ):
      val heavy        = SpatialResponse(TiltModel.of(Deviation(mass = 1.3).quadrotor), Some(model.predictor))
      val timing       = LoopTiming.Predictive(predictor = heavy.predictor)
      val (fast, slow) =
        (
          flown(timing, DelayTable.vpn, shared, false, heavy),
          flown(timing, DelayTable.vpn, shared, true, heavy)
        )
      for number <- fast.indices; world <- candidates.indices do
        assertEqualsDouble(fast(number)(world).toDouble, slow(number)(world).toDouble, 5e-3)

  test("climbs are not predicted with a model of level flight, and the reason is given"):
    val timing = LoopTiming.Predictive(predictor = skein.vehicle.ConstantVelocity)
    val engine = TeamBatch(timing, model).engine(candidates.head, true, Seq(DelayTable.vpn))
    assert(engine.text.contains("SIMD predicts climbs by a model in space"), engine.text)

object SpaceLanesSuite:
  private def team(speedMps: Double, climbMps: Double) = Vector(
    agent(0, speedMps, Helix(climbMps)),
    agent(1, speedMps + 1, Above(0, 3)),
    agent(2, speedMps, Stairs(climbMps))
  )

  private def agent(i: Int, speedMps: Double, policy: Policy) = Agent(
    s"V$i",
    Role("Scout"),
    MetresPerSecond(speedMps),
    Vector3(9 * i, 5 * i, -14 - 3 * i),
    Radians(0),
    policy
  )

  /** Climbs and sinks on a circle; the memory is the phase, as a case class. */
  private final case class Helix(climbMps: Double) extends Policy:
    type Memory = Phase
    def start: Phase                                              = Phase(0, 0)
    def choose(seen: Observation, memory: Phase): (Action, Phase) =
      val angle      = memory.angle + 0.4 * seen.elapsed.toSeconds
      val (cos, sin) = (StrictMath.cos(angle), StrictMath.sin(angle))
      val climb      = -climbMps * sin - 0.5
      (
        Action.Velocity(Vector3(seen.cruise.value * cos, seen.cruise.value * sin, climb), Yaw.Forward),
        Phase(angle, memory.timeS + seen.elapsed.toSeconds)
      )

  private final case class Phase(angle: Double, timeS: Double)

  /** Flies to the position above another vehicle, according to that vehicle's altitude and sink rate. */
  private final case class Above(other: Int, aboveM: Double) extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val (there, here) = (seen.vehicles(other).kinematics, seen.own.kinematics)
      val way           = there.positionNed + Vector3(0, 0, -aboveM) - here.positionNed
      val speed         = seen.cruise.value.min(way.norm)
      val along         = way * (speed / way.norm.max(1e-3))
      (Action.Velocity(along + Vector3(0, 0, 0.3 * there.velocityNed.z)), ())

  /** Holds several altitudes in turn; near the altitude of its start it commands a velocity instead. */
  private final case class Stairs(climbMps: Double) extends Policy:
    type Memory = Double
    def start: Double                                               = 0
    def choose(seen: Observation, memory: Double): (Action, Double) =
      val timeS  = memory + seen.elapsed.toSeconds
      val goal   = seen.startDown.value - climbMps * timeS
      val isLow  = seen.own.kinematics.positionNed.z > seen.startDown.value - 1
      val action =
        if isLow then Action.Velocity(Vector3(2, 1, -climbMps)) else Action.VelocityAt(3, -1, Metres(goal))
      (action, timeS)

  private case object Height extends Quantity:
    def of(at: Positions): Double = (0 until at.count).map(at.downM(_)).min

  private case object Apart extends Quantity:
    def of(at: Positions): Double =
      val distances =
        for i <- 0 until at.count; j <- 0 until i
        yield
          val (north, east, down) =
            (at.northM(i) - at.northM(j), at.eastM(i) - at.eastM(j), at.downM(i) - at.downM(j))
          StrictMath.sqrt(north * north + east * east + down * down)
      distances.min
