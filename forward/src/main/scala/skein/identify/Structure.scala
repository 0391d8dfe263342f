package skein.identify

import skein.vehicle.ReducedModel

/** Which parameters of a [[skein.vehicle.ReducedModel]] are free; the others say that their effect is absent.
  *
  * @param parameters
  *   names and units, in the order of a fit's vector
  */
enum Structure(val label: String, val parameters: Vector[String]):
  /** A first-order lag with gain and dead time: what the SIMD kernels fly. */
  case Lag extends Structure("lag", Vector("gain", "lag-s", "dead-time-s"))

  /** Besides, the velocity across the command has a lag of its own. */
  case Turn extends Structure("turn", Vector("gain", "lag-s", "dead-time-s", "turn-lag-s"))

  /** Besides, quadratic drag; one lag in all directions. */
  case Drag extends Structure("drag", Vector("gain", "lag-s", "dead-time-s", "drag-per-m"))

  /** Both. */
  case DragAndTurn
      extends Structure("drag-and-turn", Vector("gain", "lag-s", "dead-time-s", "drag-per-m", "turn-lag-s"))

  def model(values: Array[Double]): ReducedModel =
    val Array(gain, lag, dead) = values.take(3): @unchecked
    this match
      case Lag         => ReducedModel(gain, lag, dead, lag, 0)
      case Turn        => ReducedModel(gain, lag, dead, values(3), 0)
      case Drag        => ReducedModel(gain, lag, dead, lag, values(3))
      case DragAndTurn => ReducedModel(gain, lag, dead, values(4), values(3))

  private[identify] def start: Array[Double] = parameters.map(Structure.guess).toArray
  private[identify] def least: Array[Double] = parameters.map(Structure.bounds(_)._1).toArray
  private[identify] def most: Array[Double]  = parameters.map(Structure.bounds(_)._2).toArray

object Structure:
  def parse(label: String): Either[String, Structure] =
    values
      .find(_.label == label)
      .toRight(s"expected a structure (${values.map(_.label).mkString(", ")}), came '$label'")

  private val guess =
    Map("gain" -> 0.9, "lag-s" -> 1.0, "turn-lag-s" -> 1.0, "dead-time-s" -> 0.05, "drag-per-m" -> 0.005)

  /** Wider than any multirotor; a fit that ends at a bound says so. */
  private[identify] val bounds: Map[String, (Double, Double)] = Map(
    "gain"        -> (0.05, 5.0),
    "lag-s"       -> (0.02, 30.0),
    "turn-lag-s"  -> (0.02, 30.0),
    "dead-time-s" -> (0.0, 1.0),
    "drag-per-m"  -> (0.0, 1.0)
  )
