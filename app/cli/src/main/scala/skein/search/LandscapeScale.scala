package skein.search

import skein.measure.Distribution
import skein.optimise.Direction
import skein.plot.ColourScale

/** Chooses the range of colours for a map of an objective. */
object LandscapeScale:
  /** The share of cells, the best ones, that are always distinguishable. */
  private val Told = 0.9

  /** The maximum share of the scale that the other cells may take before it is cut. */
  private val MostOfRest = 0.25

  /** A scale from the least to the greatest mean. If the worst tenth of the cells would take more than a
    * quarter of it, the scale ends before them, so that cells near the best differ in colour.
    */
  def of(means: Vector[Double], direction: Direction): ColourScale =
    Distribution.of(means.filter(_.isFinite).map(direction.sign * _)) match
      case None       => ColourScale.viridis(0, 1)
      case Some(cost) =>
        val cut   = cost.quantile(Told)
        val isCut = cost.most - cut > MostOfRest * (cost.most - cost.least) && cut > cost.least
        val worst = direction.sign * (if isCut then cut else cost.most)
        val best  = direction.sign * cost.least
        ColourScale
          .viridis(best.min(worst), best.max(worst))
          .copy(beyond =
            if !isCut then Set.empty
            else if direction == Direction.Minimise then Set(ColourScale.End.High)
            else Set(ColourScale.End.Low)
          )
