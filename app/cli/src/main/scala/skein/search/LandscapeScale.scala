package skein.search

import skein.measure.Distribution
import skein.optimise.Direction
import skein.plot.ColourScale

/** Which colours a map of an objective has. */
object LandscapeScale:
  /** This share of the cells, the better ones, is told apart in any case. */
  private val Told = 0.9

  /** Of the scale, so much may belong to the rest without the scale being cut. */
  private val MostOfRest = 0.25

  /** From the least to the most; where the worst tenth of the cells would take more than a quarter of that,
    * the scale ends before it, so that what is near the best does not all have one colour.
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
