package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.*
import skein.fusion.*
import skein.units.*
import skein.vtime.VirtualTime

class FuseSuite extends munit.FunSuite:
  private def at(ms: Int): Instant = Instant.Epoch + Span.ofMillis(ms)

  /** A measurement of a vehicle that flies north at 8 m/s. */
  private def measured(ms: Int, variance: Double = 0.01) =
    Measurement(at(ms), Vector3(0.008 * ms, 0, 0), Matrix3.diagonal(variance))

  private def fused(measurements: (String, Measurement)*) =
    var tooOld  = Vector.empty[(String, Measurement)]
    val beliefs = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      Source(measurements)
        .via(Fuse[String](FusionSettings(history = Span.ofMillis(500)))((key, one) => tooOld :+= (key, one)))
        .runWith(Sink.seq)
    (beliefs.value, tooOld)

  test("a detection counts at its exposure even after newer readings"):
    val inOrder = (0 to 10).map(i => "evader" -> measured(i * 50))
    val late    = inOrder.patch(4, Nil, 1) :+ inOrder(4)
    assertEquals(fused(late*)._1.last, fused(inOrder*)._1.last)

  test("treating a late detection as new would shift the estimate by the distance covered since"):
    val readings                     = (0 to 10).map(i => "evader" -> measured(i * 50))
    val seen                         = measured(350, variance = 0.0025)
    def offM(detection: Measurement) =
      val (beliefs, _) = fused((readings :+ ("evader" -> detection))*)
      math.abs(beliefs.last._2.positionNed.x - 0.008 * 500)
    assert(offM(seen) < 0.01, offM(seen))
    assert(offM(seen.copy(validAt = at(500))) > 0.5, offM(seen.copy(validAt = at(500))))

  test("each vehicle has its own estimate, and measurements that are too old are reported and stop nothing"):
    val (beliefs, tooOld) =
      fused("a" -> measured(1000), "b" -> measured(100), "a" -> measured(200), "b" -> measured(300))
    assertEquals(
      beliefs.map((key, belief) => key -> belief.at),
      Seq("a" -> at(1000), "b" -> at(100), "b" -> at(300))
    )
    assertEquals(tooOld, Vector("a" -> measured(200)))
