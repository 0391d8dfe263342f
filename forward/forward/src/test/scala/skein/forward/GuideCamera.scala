package skein.forward

import skein.fusion.SensorModel
import skein.signal.LatencyDistribution
import skein.units.Span

/** A camera and its recogniser, as in docs/guides/recognition.md. */
object GuideCamera:
  val model: SensorModel = SensorModel(
    everyS = 0.1,
    fovRad = StrictMath.toRadians(100),
    farthestM = 40,
    detection = 0.95,
    bearingSdRad = 0.002,
    rangeBias = 1,
    rangeSd = 0.03,
    takes = LatencyDistribution.Uniform(Span.ofMillis(15), Span.ofMillis(120))
  )
