package skein.torture

import java.nio.ByteBuffer
import skein.fusion.PolarMeasurement
import skein.scenario.{Eye, Recogniser}
import skein.signal.{LatencyDistribution, LatencyProfile, SplitMix64}
import skein.units.*

/** An eye with a faulty recogniser: it reports false detections, misses objects, refuses images, fails, and
  * is late. No decision uses it.
  */
private[torture] object FaultyEye:
  def apply(vehicle: String, target: String, seed: Long): Eye = Eye(
    vehicle,
    "faulty eye",
    "front_center",
    target,
    every = Span.ofMillis(100),
    () => FaultyRecogniser(seed),
    LatencyProfile.Steady("", LatencyDistribution.Uniform(Span.ofMillis(2), Span.ofMillis(200))),
    workers = 2,
    deadline = Span.ofMillis(120)
  )

  private final class FaultyRecogniser(seed: Long) extends Recogniser:
    private val random = SplitMix64(SplitMix64.seedOf(seed, 4))

    def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[PolarMeasurement]] =
      random.nextInt(10) match
        case 0     => throw IllegalStateException("a faulty recogniser")
        case 1     => Left("refused by a faulty recogniser")
        case 2 | 3 => Right(None)
        case _     =>
          val anywhere = Vector3(5 + 20 * random.nextDouble(), 10 * random.nextDouble() - 5, 0)
          Right(Some(PolarMeasurement.of(
            anywhere,
            (azimuth = Radians(0.01), elevation = Radians(0.01), range = Metres(1))
          )))
