package skein.identify

import skein.vehicle.ReducedFlight

/** Where a vehicle was and how fast, horizontally: s, m, m/s. */
final case class Sample(atS: Double, x: Double, y: Double, vx: Double, vy: Double)

/** A commanded horizontal velocity and when it came to the vehicle: s, m/s. */
final case class Arrival(atS: Double, vx: Double, vy: Double)

/** One vehicle's flight: what it was told and what it did, on one clock, both in the order of their times.
  *
  * @param downM
  *   the altitude that its commands keep, NED
  */
final case class Flown(name: String, samples: Vector[Sample], arrivals: Vector[Arrival], downM: Double):

  private val times = arrivals.map(_.atS).toArray

  /** Predicts from one sample over all later ones within a horizon.
    *
    * @param flight
    *   of a model with this dead time
    * @param each
    *   told of each later sample's index, when the flight is there
    */
  def predict(
      flight: ReducedFlight,
      deadTimeS: Double,
      from: Int,
      horizonS: Double
  )(each: Int => Unit): Unit =
    val start = samples(from)
    // The first command that does not act yet.
    var next     = firstAfter(start.atS - deadTimeS)
    val (ux, uy) = if next == 0 then (0.0, 0.0) else (arrivals(next - 1).vx, arrivals(next - 1).vy)
    flight.start(start.atS, start.x, start.y, start.vx, start.vy, ux, uy)
    var sample = from + 1
    while sample < samples.size && samples(sample).atS <= start.atS + horizonS + Flown.Rounding do
      val atS = samples(sample).atS
      while next < arrivals.size && times(next) + deadTimeS <= atS do
        flight.act(times(next) + deadTimeS, arrivals(next).vx, arrivals(next).vy)
        next += 1
      flight.advance(atS)
      each(sample)
      sample += 1

  /** Indices of samples at least this far apart from each other, from each of which a whole horizon can be predicted. */
  def starts(everyS: Double, horizonS: Double): Vector[Int] =
    val last = samples.lastOption.fold(0.0)(_.atS) - horizonS + Flown.Rounding
    samples.indices
      .foldLeft(Vector.empty[Int]): (chosen, index) =>
        val atS = samples(index).atS
        if atS <= last && chosen.lastOption.forall(before =>
            atS >= samples(before).atS + everyS - Flown.Rounding
          )
        then chosen :+ index
        else chosen

  /** Index of the sample nearest to a time, not before `from`. */
  def nearest(timeS: Double, from: Int): Int =
    var index = from
    while index + 1 < samples.size && math.abs(samples(index + 1).atS - timeS) <= math.abs(
        samples(index).atS - timeS
      )
    do
      index += 1
    index

  private def firstAfter(timeS: Double): Int =
    val found = java.util.Arrays.binarySearch(times, timeS)
    var index = if found >= 0 then found + 1 else -found - 1
    while index < times.length && times(index) <= timeS do index += 1
    index

object Flown:
  private[identify] val Rounding = 1e-9
