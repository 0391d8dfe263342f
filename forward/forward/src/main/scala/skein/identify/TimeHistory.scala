package skein.identify

import skein.policy.Action
import skein.vehicle.{ObservedPlant, PlaneReading, PlantFlight}

/** Horizontal position, m, and velocity, m/s, of a vehicle at a time, s. */
final case class Sample(atS: Double, x: Double, y: Double, vx: Double, vy: Double):
  def reading: PlaneReading = PlaneReading(x, y, vx, vy)

/** A commanded velocity, and the time of its arrival at the vehicle, s.
  *
  * @param action a velocity, with an altitude to hold or without
  */
final case class ArrivedCommand(atS: Double, action: Action):
  /** The velocity north and east, m/s, whatever it is downwards. */
  val (vx, vy): (Double, Double) = action.byVelocity match
    case Action.Velocity(velocity, _)         => (velocity.x, velocity.y)
    case Action.VelocityAt(north, east, _, _) => (north, east)
    case other => throw IllegalArgumentException(s"expected a velocity, got $other")

  /** The altitude that it holds, m, NED; absent for a velocity down. */
  def heldDownM: Option[Double] = action match
    case Action.VelocityAt(_, _, down, _) => Some(down.value)
    case Action.Along(_, _, down, _)      => Some(down.value)
    case _                                => None

/** A stretch of one vehicle's flight: the commands that arrived, and samples of its motion. Both are on one
  * clock and ordered by time.
  *
  * @param downM altitude at the first sample, NED
  */
final case class TimeHistory(
    name: String,
    samples: Vector[Sample],
    arrivals: Vector[ArrivedCommand],
    downM: Double
):

  private val times = arrivals.map(_.atS).toArray

  def spanS: Double = samples.lastOption.fold(0.0)(_.atS - samples.head.atS)

  /** The plant's state at each sample: predicted from the sample before, then corrected by the sample. */
  def states[S](plant: ObservedPlant[S]): Vector[S] =
    val flight = PlantFlight(plant)
    val first  = samples.headOption.map(sample => plant.corrected(plant.initial, sample.reading))
    first.toVector.flatMap: first =>
      (1 until samples.size).scanLeft(first): (state, sample) =>
        predict(flight, state, sample - 1, samples(sample).atS - samples(sample - 1).atS)(_ => ())
        plant.corrected(flight.state, samples(sample).reading)

  /** Predicts from one sample over all later samples within a horizon.
    *
    * @param state the plant's state at that sample
    * @param each called for each later sample with its index, when the prediction has reached its time
    */
  def predict[S](flight: PlantFlight[S], state: S, from: Int, horizonS: Double)(each: Int => Unit): Unit =
    val deadTimeS = flight.plant.deadTimeS
    val start     = samples(from)
    // The first command that is not in effect yet.
    var next     = firstAfter(start.atS - deadTimeS)
    val (ux, uy) = if next == 0 then (0.0, 0.0) else (arrivals(next - 1).vx, arrivals(next - 1).vy)
    flight.start(start.atS, state, ux, uy)
    var sample = from + 1
    while sample < samples.size && samples(sample).atS <= start.atS + horizonS + TimeHistory.Rounding do
      val atS = samples(sample).atS
      while next < arrivals.size && times(next) + deadTimeS <= atS do
        flight.act(times(next) + deadTimeS, arrivals(next).vx, arrivals(next).vy)
        next += 1
      flight.advance(atS)
      each(sample)
      sample += 1

  /** Indices of samples that are at least `everyS` apart and from which a whole horizon can be predicted. */
  def starts(everyS: Double, horizonS: Double): Vector[Int] =
    val last = samples.lastOption.fold(0.0)(_.atS) - horizonS + TimeHistory.Rounding
    samples.indices
      .foldLeft(Vector.empty[Int]): (chosen, index) =>
        val atS = samples(index).atS
        if atS <= last && chosen.lastOption.forall(before =>
            atS >= samples(before).atS + everyS - TimeHistory.Rounding
          )
        then chosen :+ index
        else chosen

  /** Index of the sample nearest to a time, from index `from` on. */
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

object TimeHistory:
  private[identify] val Rounding = 1e-9
