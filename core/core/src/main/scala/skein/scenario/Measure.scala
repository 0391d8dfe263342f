package skein.scenario

/** A value computed from a flight, for example `Measure("out of sight", "s")(tracks => …)`.
  *
  * @param unit unit of the value; may be empty
  * @param isCount whether it counts events, which are summed over several flights
  * @param over the part of the flight that is measured; a shorter flight has no value
  * @param parts the quantities that are reduced, if the measure needs nothing else; searches can optimise
  *   only such measures
  * @param joined the value for the reductions of [[parts]], in their order
  */
final class Measure private (
    val name: String,
    val unit: String,
    val isCount: Boolean,
    val over: Window,
    val parts: Vector[OverFlight],
    joined: Option[Vector[Double] => Option[Double]],
    value: Tracks => Option[Double]
):
  /** The quantity that is reduced, if the measure is this reduction. */
  def reduced: Option[OverFlight] = if joined.isEmpty then parts.headOption else None

  /** The value for the reductions of [[parts]], in their order; a time that is never reached is infinite. */
  private[skein] def of(reductions: Vector[Double]): Option[Double] =
    joined.fold(reductions.headOption)(_(reductions)).filter(_.isFinite)

  /** The value for a flight. None if the flight has none, for example a time of arrival without an arrival,
    * or if the value is not finite.
    */
  def of(tracks: Tracks): Option[Double] = value(tracks).filter(_.isFinite)

  def title: String = s"$name $unit".trim

  /** The measure for only the first vehicles; for reports, not for searches. */
  private[scenario] def ofFirst(count: Int): Measure =
    new Measure(name, unit, isCount, over, Vector.empty, None, tracks => of(tracks.first(count)))

object Measure:
  def apply(name: String, unit: String)(of: Tracks => Option[Double]): Measure =
    new Measure(name, unit, false, Window.Whole, Vector.empty, None, of)

  /** A measure that counts events, for example vehicles that arrived. */
  def count(name: String)(of: Tracks => Int): Measure =
    new Measure(name, "", true, Window.Whole, Vector.empty, None, tracks => Some(of(tracks).toDouble))

  /** A measure computed from others, for example the mean time of arrival of several vehicles. It is of as
    * much of a flight as they are. Searches can optimise it if they can optimise each of them.
    *
    * @param isCount whether it counts events
    * @param of the value for those of the parts, in their order; a part may have none
    */
  def join(name: String, unit: String, parts: Vector[Measure], isCount: Boolean = false)(
      of: Vector[Option[Double]] => Option[Double]
  ): Measure =
    val reduced = if parts.forall(_.reduced.nonEmpty) then parts.flatMap(_.reduced) else Vector.empty
    new Measure(
      name,
      unit,
      isCount,
      Window.Whole,
      reduced,
      Some(values => of(parts.zip(values).map((part, value) => part.of(Vector(value))))),
      tracks => of(parts.map(_.of(tracks)))
    )

  /** @param by the quantity that is reduced, if the measure is its reduction */
  private[scenario] def over(
      name: String,
      unit: String,
      isCount: Boolean,
      part: Window,
      by: Option[OverFlight]
  )(of: (Tracks, Range) => Double): Measure =
    new Measure(name, unit, isCount, part, by.toVector, None, tracks => part.of(tracks).map(of(tracks, _)))

/** A quantity over a part of a flight, reduced to one value. */
final case class OverFlight(quantity: Quantity, reduction: Reduction, over: Window)

/** A quantity over the time of a flight, which reports draw and measures reduce.
  *
  * {{{
  * private val apart = Series("distance", "m")(tracks => instant => tracks.separationM(0, 1, instant))
  * override def series   = Vector(apart)
  * override def measures = Vector(apart.mean("mean distance"), apart.least("closest"))
  * }}}
  *
  * @param bound value with which the quantity is compared, drawn as a line
  * @param at value of the quantity at an instant
  */
final class Series private (
    val name: String,
    val unit: String,
    val bound: Option[Bound],
    quantity: Option[Quantity]
)(at: Tracks => Int => Double):

  def curve(tracks: Tracks): Curve = Curve(tracks, at(tracks))

  def title: String = if unit.isEmpty then name else s"$name, $unit"

  def mean(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.Mean)

  def rms(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.Rms)

  def sd(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.Sd)

  def least(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.Least)

  def most(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.Most)

  /** First time at which the quantity has its minimum, s. */
  def leastAt(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.LeastAt)

  /** First time at which the quantity has its maximum, s. */
  def mostAt(name: String, over: Window = Window.Whole): Measure = measure(name, over, Reduction.MostAt)

  /** Total time in which the quantity is above a bound, s. */
  def timeAbove(name: String, bound: Double, over: Window = Window.Whole): Measure =
    above(bound).measure(name, over, Reduction.TimePositive)

  /** Total time in which the quantity is below a bound, s. */
  def timeBelow(name: String, bound: Double, over: Window = Window.Whole): Measure =
    below(bound).measure(name, over, Reduction.TimePositive)

  /** First time at which the quantity is above a bound, s; no value if it never is. */
  def firstAbove(name: String, bound: Double): Measure =
    above(bound).measure(name, Window.Whole, Reduction.FirstPositive)

  /** First time at which the quantity is below a bound, s; no value if it never is. */
  def firstBelow(name: String, bound: Double): Measure =
    below(bound).measure(name, Window.Whole, Reduction.FirstPositive)

  /** How many times the quantity comes to be above a bound. */
  def timesAbove(name: String, bound: Double, over: Window = Window.Whole): Measure =
    above(bound).measure(name, over, Reduction.Entries)

  /** How many times the quantity comes to be below a bound. */
  def timesBelow(name: String, bound: Double, over: Window = Window.Whole): Measure =
    below(bound).measure(name, over, Reduction.Entries)

  /** Time from which the quantity stays above a bound until the end, s; no value if it ends otherwise. */
  def staysAbove(name: String, bound: Double): Measure =
    above(bound).measure(name, Window.Whole, Reduction.StaysPositive)

  /** Time from which the quantity stays below a bound until the end, s; no value if it ends otherwise. */
  def staysBelow(name: String, bound: Double): Measure =
    below(bound).measure(name, Window.Whole, Reduction.StaysPositive)

  private def above(bound: Double): Series =
    if bound == 0 then this
    else new Series(name, unit, None, quantity.map(Excess(_, bound)))(tracks => at(tracks).andThen(_ - bound))

  private def below(bound: Double): Series =
    new Series(name, unit, None, quantity.map(Shortfall(_, bound)))(tracks => at(tracks).andThen(bound - _))

  private[scenario] def measure(name: String, over: Window, reduction: Reduction): Measure =
    val isCount = reduction == Reduction.Entries
    val unit    = if isCount then "" else if reduction.isTime then "s" else this.unit
    Measure.over(name, unit, isCount, over, quantity.map(OverFlight(_, reduction, over))):
      (tracks, instants) =>
        reduction.of(instants.map(at(tracks)), index => tracks.timeS(instants(index)), tracks.stepS)

object Series:
  def apply(name: String, unit: String, bound: Option[Bound] = None)(at: Tracks => Int => Double): Series =
    new Series(name, unit, bound, None)(at)

  /** A series of a quantity that searches can optimise. */
  def of(name: String, unit: String, quantity: Quantity, bound: Option[Bound] = None): Series =
    new Series(name, unit, bound, Some(quantity))(tracks =>
      instant => Quantity.told(quantity, tracks.positions(instant))
    )

/** A value with which a quantity is compared, drawn as a line.
  *
  * @param name its name in the legend
  */
final case class Bound(name: String, value: Double)

/** The values of a quantity at equidistant times, which are seconds since all vehicles were first read. */
final case class Curve(points: Vector[(Double, Double)]):

  /** The stretches of the curve in which all values are finite. */
  def stretches: Vector[Vector[(Double, Double)]] =
    Vector.unfold(points): left =>
      val (stretch, rest) = left.dropWhile(!_._2.isFinite).span(_._2.isFinite)
      Option.when(stretch.nonEmpty)((stretch, rest))

object Curve:
  def apply(tracks: Tracks, value: Int => Double): Curve =
    Curve(tracks.instants.toVector.map(instant => (tracks.timeS(instant), value(instant))))
