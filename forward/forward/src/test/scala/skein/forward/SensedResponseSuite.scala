package skein.forward

import scala.collection.mutable.ArrayBuffer
import skein.vehicle.SensorNoise

class SensedResponseSuite extends munit.FunSuite:
  private val ideal: VelocityResponse = VelocityResponses.Ideal

  private def sensed(text: String) = SensedResponse(ideal, SensorNoise.parse(text).fold(fail(_), identity))

  private def rollout(timing: LoopTiming, model: VelocityResponse) =
    ScoredRollout(Pair.paper.engagement, timing, DelayTable.vpn, model)

  private final class Told extends LoopObserver:
    val read, scored = ArrayBuffer.empty[(Int, Double, Double, Double)]
    override def read(vehicle: Int, number: Int, atNs: Long, x: Double, y: Double, z: Double): Unit =
      read += ((vehicle, atNs * 1e-9, x, y))
    override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
      scored += ((vehicle, timeS, x, y))

  private def flown(timing: LoopTiming, model: VelocityResponse): Told =
    val told = Told()
    Rollout(Pair.paper.engagement, timing, DelayTable.vpn, model).fly(3, observer = told)
    told

  test("readings have the stated errors, and scores are of the truth"):
    val told   = flown(LoopTiming.Paused(), sensed("position=0.5"))
    val truth  = told.scored.map((vehicle, at, x, y) => (vehicle, (at * 1000).round) -> (x, y)).toMap
    val errors =
      for
        (vehicle, at, x, y) <- told.read.toVector
        (trueX, trueY)      <- truth.get((vehicle, (at * 1000).round)).toVector
        error               <- Vector(x - trueX, y - trueY)
      yield error
    assert(errors.sizeIs > 2000, errors.size)
    assertEqualsDouble(math.sqrt(errors.map(e => e * e).sum / errors.size), 0.5, 0.03)

  test("the errors are the world's own, and matter"):
    for timing <-
        Seq(LoopTiming.Stream(), LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Predictive())
    do
      def outcome(key: Int, model: VelocityResponse) = rollout(timing, model).fly(key)
      val noisy = sensed("position=0.5,velocity=0.2,drift=1/10s,outage=1s/5s")
      assertEquals(outcome(1, noisy), outcome(1, noisy))
      assertNotEquals(outcome(1, noisy).meanDistanceM, outcome(1, ideal).meanDistanceM)

  test("errors of zero change nothing, in any loop"):
    for timing <- Seq(LoopTiming.Stream(), LoopTiming.Paused(), LoopTiming.Predictive()) do
      assertEquals(rollout(timing, sensed("position=0")).fly(2), rollout(timing, ideal).fly(2))

  test("missing readings make loops decide less often, but not one that pauses the world"):
    def decisions(timing: LoopTiming, model: VelocityResponse) = rollout(timing, model).fly(4).decisions
    assert(decisions(
      LoopTiming.Stream(),
      sensed("dropout=50%")
    ) < 0.8 * decisions(LoopTiming.Stream(), ideal))
    assertEquals(decisions(LoopTiming.Paused(), sensed("dropout=50%")), decisions(LoopTiming.Paused(), ideal))
