package skein.lanes

import skein.forward.*
import skein.lanes.policy.PolicyLanes
import skein.policy.*
import skein.simd.WorldRandom
import skein.units.*

/** A policy's formula determines whether it decides by the difference of two readings, whatever it extends.
  */
class OpponentFormulaSuite extends munit.FunSuite:
  import OpponentFormulaSuite.*

  private val lag   = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val short = Pair.paper.copy(durationS = 5)

  private def refusal(policy: Policy) =
    PolicyLanes.of(policy).fold(_.getMessage, _ => fail("it was compiled"))

  test("a chase, and a weaver with a memory, decide by differences"):
    for policy <- Seq(AnyPolicySimulation.Chase, AnyPolicySimulation.Weaving(0.3), Turning(1)) do
      assertEquals(PolicyLanes.of(policy).left.map(_.getMessage).map(_ => ()), Right(()))

  test("a policy that reads one position or velocity, or commands another speed or altitude, does not"):
    assert(clue(refusal(AnyPolicySimulation.Ages)).contains("it regards Velocity(1,"))
    assert(clue(refusal(AnyPolicySimulation.Mirror)).contains("another speed than its vehicle's"))
    assert(clue(refusal(Homing(None))).contains("it regards Position(0,"))
    assert(clue(refusal(Homing(Some(3)))).contains("another speed than its vehicle's"))

  test("efforts of such policies are summed, too"):
    val batch = PairBatch(short, LoopTiming.Stream(), lag, threads = 1)
    assert(batch.engine(Turning(1), PaperEvader(), true, Seq(DelayTable.vpn)).fliesByLanes)

  for
    timing <- Seq(LoopTiming.Stream(), LoopTiming.Predictive(predictor = lag.predictor))
    shared <- Seq(true, false)
  do
    test(
      s"the paper's pursuer, rewritten, flies like Skein's, to the bit: $timing, shared episodes: $shared"
    ):
      def flown(by: Int => Policy) =
        val worlds = new PairWorlds:
          def size: Int                       = 40
          override def shareEpisodes: Boolean = shared
          def key(world: Int): Int            = WorldRandom.key(4, 0, if shared then 0 else world)
          def link(world: Int): Delays        = DelayTable.vpn
          def pursuer(world: Int): Policy     = by(world)
          def evader(world: Int): Policy      = PaperEvader()
        val out = PairBatch(short, timing, lag, threads = 1).fly(worlds)
        PairNumber.values.toVector.map(out(_).toVector)
      assertEquals(
        flown(world => Turning(0.8 + 0.01 * world)),
        flown(world => PaperPursuer(0.8 + 0.01 * world))
      )

object OpponentFormulaSuite:
  /** Turns to the side on which its opponent is, which it finds by vectors. */
  final case class Turning(rateRadPerS: Double) extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val way   = seen.vehicles(seen.opponent).kinematics.positionNed - seen.own.kinematics.positionNed
      val own   = seen.headings(seen.self).value
      val north = StrictMath.cos(own)
      val east  = StrictMath.sin(own)
      val ahead = way.x * north + way.y * east
      val aside = -way.x * east + way.y * north
      val side  = if aside != 0 then math.signum(aside) else if ahead < 0 then 1.0 else 0.0
      Action.Along(Radians(own + side * (rateRadPerS * seen.elapsed.toSeconds)), seen.cruise, seen.startDown)

  /** Flies to the origin. */
  final case class Homing(mps: Option[Double]) extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val own   = seen.own.kinematics.positionNed
      val speed = mps.fold(seen.cruise)(MetresPerSecond(_))
      Action.Along(Radians(StrictMath.atan2(-own.y, -own.x)), speed, seen.startDown)
