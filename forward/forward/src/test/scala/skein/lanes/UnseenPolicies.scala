package skein.lanes

import skein.policy.{HeadingPolicy, PlanarObservation}

/** The memory of [[TrendPursuer]]: the opponent's last bearing, and the mean rate of its change. */
final case class Trend(bearingRad: Double, rateRadPerS: Double)

/** Turns with the line of sight's average rate, and towards the opponent. The product does not contain it. */
final case class TrendPursuer(gain: Double, forgetS: Double, turnRateRadPerS: Double)
    extends HeadingPolicy:
  type Memory = Trend
  def start: Trend = Trend(0, 0)

  def decide(seen: PlanarObservation, memory: Trend): (Double, Trend) =
    val bearing = StrictMath.atan2(seen.dyM, seen.dxM)
    val trend   =
      if seen.elapsedS > 0 then
        val rate  = wrapped(bearing - memory.bearingRad) / seen.elapsedS
        val share = 1 - StrictMath.exp(-seen.elapsedS / forgetS)
        Trend(bearing, memory.rateRadPerS + share * (rate - memory.rateRadPerS))
      else Trend(bearing, 0)
    val wanted = gain * trend.rateRadPerS + wrapped(bearing - seen.ownHeadingRad)
    val rate   = wanted.max(-turnRateRadPerS).min(turnRateRadPerS)
    (seen.ownHeadingRad + rate * seen.elapsedS, trend)

  private def wrapped(angleRad: Double) = math.IEEEremainder(angleRad, 2 * math.Pi)

/** Heads for the opponent's present position, extrapolated by its velocity over the age of its reading. */
final case class AgeAwarePursuer(ownSpeedMps: Double, trust: Double, turnRateRadPerS: Double)
    extends HeadingPolicy.Memoryless:

  def heading(seen: PlanarObservation): Double =
    val (cos, sin) = (StrictMath.cos(seen.ownHeadingRad), StrictMath.sin(seen.ownHeadingRad))
    // The opponent's own velocity, if this vehicle's is as commanded.
    val north = seen.dvxMps + ownSpeedMps * cos
    val east  = seen.dvyMps + ownSpeedMps * sin
    val dx    = seen.dxM + trust * (north * seen.opponentAgeS - ownSpeedMps * cos * seen.ownAgeS)
    val dy    = seen.dyM + trust * (east * seen.opponentAgeS - ownSpeedMps * sin * seen.ownAgeS)
    val turn  = math.IEEEremainder(StrictMath.atan2(dy, dx) - seen.ownHeadingRad, 2 * math.Pi)
    val most  = turnRateRadPerS * seen.elapsedS
    seen.ownHeadingRad + turn.max(-most).min(most)

/** A network with two hidden layers of 16 rectified neurons, written without knowledge of Skein's networks.
  */
final class RectifiedNetwork(weights: Array[Double], turnRateRadPerS: Double)
    extends HeadingPolicy.Memoryless:
  require(weights.length == RectifiedNetwork.Weights)

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val (cos, sin) = (StrictMath.cos(ownHeadingRad), StrictMath.sin(ownHeadingRad))
    val inputs     = Array(
      (dxM * cos + dyM * sin) / 20,
      (dyM * cos - dxM * sin) / 20,
      (dvxMps * cos + dvyMps * sin) / 10,
      (dvyMps * cos - dvxMps * sin) / 10
    )
    val hidden = layer(layer(inputs, 0, 16), 16 * 5, 16)
    ownHeadingRad + turnRateRadPerS * elapsedS * StrictMath.tanh(neuron(hidden, 16 * 5 + 16 * 17))

  private def layer(inputs: Array[Double], from: Int, neurons: Int): Array[Double] =
    Array.tabulate(neurons)(i => neuron(inputs, from + i * (inputs.length + 1)).max(0.0))

  private def neuron(inputs: Array[Double], from: Int): Double =
    var sum = weights(from + inputs.length)
    for i <- inputs.indices do sum += weights(from + i) * inputs(i)
    sum

object RectifiedNetwork:
  val Weights: Int = 16 * 5 + 16 * 17 + 17
