package skein.scenario

import skein.units.{OwnFailure, Vector3}

/** Positions of all vehicles at one moment, by index in the scenario. World frame NED, m.
  *
  * @param elapsedS time since all vehicles were first read, s: in forward simulation, since its start
  */
final case class Positions(
    northM: IArray[Double],
    eastM: IArray[Double],
    downM: IArray[Double],
    elapsedS: Double = 0
):
  def count: Int = northM.length

  def ned(vehicle: Int): Vector3 = Vector3(northM(vehicle), eastM(vehicle), downM(vehicle))

  /** Horizontal distance between two vehicles, m. */
  def distanceM(one: Int, other: Int): Double =
    StrictMath.hypot(northM(one) - northM(other), eastM(one) - eastM(other))

  /** Horizontal distance from a vehicle to a position, m. */
  def distanceM(vehicle: Int, north: Double, east: Double): Double =
    StrictMath.hypot(northM(vehicle) - north, eastM(vehicle) - east)

/** A value computed from the positions of all vehicles at one moment, and from its time. Reports draw it,
  * measures reduce it, and searches optimise it. Pure. If its method is plain arithmetic, it is compiled to
  * SIMD, as policies are (`docs/guides/formulas.md`).
  */
trait Quantity:
  def of(positions: Positions): Double

object Quantity:
  /** Evaluates a quantity.
    *
    * @throws OwnFailure if the quantity throws
    */
  private[skein] def told(quantity: Quantity, positions: Positions): Double =
    OwnFailure.told(whose(quantity))(quantity.of(positions))

  private[skein] def whose(quantity: Quantity): String = OwnFailure.named("quantity", quantity)

private[scenario] final case class Excess(quantity: Quantity, bound: Double) extends Quantity:
  def of(positions: Positions): Double = quantity.of(positions) - bound

private[scenario] final case class Shortfall(quantity: Quantity, bound: Double) extends Quantity:
  def of(positions: Positions): Double = bound - quantity.of(positions)

/** Reduces a quantity's values over time to one value. */
enum Reduction:
  case Mean, Rms, Sd, Least, Most

  /** First time of the minimum or the maximum value, s. */
  case LeastAt, MostAt

  /** Total time in which the value was above 0, s. */
  case TimePositive

  /** First time at which the value was above 0, s; infinite if it never was. */
  case FirstPositive

  /** Time from which the value was above 0 until the end, s; infinite if the last value was not. */
  case StaysPositive

  /** How many times the value became positive, a positive first value included. */
  case Entries

  /** Whether it is a time, not a value of the quantity. */
  private[scenario] def isTime: Boolean = !Set(Mean, Rms, Sd, Least, Most, Entries)(this)

  /** Whether it is a time that may never come. */
  private[skein] def mayBeNever: Boolean = this == FirstPositive || this == StaysPositive

  /** @param timesS the times of the values, ascending
    * @param stepS time between two values
    */
  def of(values: IndexedSeq[Double], timesS: Int => Double, stepS: Double): Double =
    def timeOf(index: Int) =
      if values.indices.contains(index) then timesS(index) else Double.PositiveInfinity
    this match
      case Mean          => values.sum / values.size
      case Rms           => math.sqrt(values.map(value => value * value).sum / values.size)
      case Least         => values.min
      case Most          => values.max
      case LeastAt       => timesS(values.indices.minBy(values))
      case MostAt        => timesS(values.indices.maxBy(values))
      case TimePositive  => values.count(_ > 0) * stepS
      case FirstPositive => timeOf(values.indexWhere(_ > 0))
      case StaysPositive => timeOf(values.lastIndexWhere(value => !(value > 0)) + 1)
      case Entries       =>
        values.indices.count(index => values(index) > 0 && (index == 0 || !(values(index - 1) > 0)))
      case Sd =>
        val mean = values.sum / values.size
        math.sqrt(values.map(value => (value - mean) * (value - mean)).sum / values.size)
