package skein.environment

import skein.forward.Duel
import skein.signal.SplitMix64

/** The vehicles' positions at the begin of an episode, at rest: north and east, m, and the headings assumed
  * as commanded.
  */
private final case class Start(
    evaderNorthM: Float,
    evaderEastM: Float,
    evaderHeadingRad: Float,
    pursuerNorthM: Float,
    pursuerEastM: Float,
    pursuerHeadingRad: Float
):
  def distanceM: Float =
    StrictMath.hypot(evaderNorthM - pursuerNorthM, evaderEastM - pursuerEastM).toFloat

private object Start:

  /** @param withinM the least and the greatest distance, any direction; both 0: the duel's own start */
  def of(duel: Duel, withinM: (Double, Double), seed: Long): Start =
    import duel.{evader, pursuer}
    val (evaderX, evaderY, evaderRad, pursuerRad) =
      if withinM._2 == 0 then (evader.startX, evader.startY, evader.startHeadingRad, pursuer.startHeadingRad)
      else
        val random              = SplitMix64(seed)
        def angle()             = (2 * random.nextDouble() - 1) * math.Pi
        val (distance, bearing) = (withinM._1 + random.nextDouble() * (withinM._2 - withinM._1), angle())
        (
          pursuer.startX + distance * StrictMath.cos(bearing),
          pursuer.startY + distance * StrictMath.sin(bearing),
          angle(),
          angle()
        )
    Start(
      evaderX.toFloat,
      evaderY.toFloat,
      evaderRad.toFloat,
      pursuer.startX.toFloat,
      pursuer.startY.toFloat,
      pursuerRad.toFloat
    )
