package skein.lanes.loop

import scala.collection.mutable
import skein.forward.{Delays, RolloutAgent, LoopTiming, Steering, TabledDelays}
import skein.vehicle.SensorNoise

/** A loop for worlds with separate delays: it computes the offers, the pacing of commands, and how long the
  * vehicles' history is needed. Mutable, because its offers are; one per kernel.
  *
  * @param predictors of the vehicles that are read, if the loop predicts
  * @param maxDelayS the longest one-way delay of any link
  * @param sees whether images are taken, which require the vehicles' positions at any time
  * @param noise errors of each vehicle's readings, of which some may be missing
  * @param shortCut whether SIMD computes regular stretches of `stream`; if false, each world is computed
  *   separately, with equal results
  */
private[lanes] final class LoopLanes(
    val timing: LoopTiming,
    predictors: Vector[Option[LanePredictor]],
    val durationS: Double,
    maxDelayS: Double,
    val sees: Boolean = false,
    noise: Vector[Option[SensorNoise]] = Vector.empty,
    shortCut: Boolean = true
):
  private val vehicles = predictors.size
  private val missing  = MissingReadings(
    predictors.indices.map(noise.lift(_).flatten.flatMap(_.ofMissing).orNull).toArray
  )

  /** The forecast; null if decisions use the readings themselves. */
  val forecast: LaneForecast =
    val by = predictors.flatten
    if by.isEmpty then null
    else LaneForecast(timing.periodS, by.map(_.deadTimeS).toArray, by.exists(_.inSpace))

  /** Sets the model that predicts a vehicle, and the source of its readings; does nothing in loops that do
    * not predict.
    */
  def carryForward(vehicle: Int, agent: RolloutAgent, read: LaneVehicles): Unit =
    for by <- predictors(vehicle) do forecast.follow(vehicle, by.alone(agent), read)

  val offers: LaneOffers = timing match
    case stream: LoopTiming.Stream =>
      StreamOffers(stream, vehicles, durationS, maxDelayS, shortCut, missing)
    case sequential: LoopTiming.Sequential => SequentialOffers(sequential, vehicles, missing)
    case futures: LoopTiming.Futures       => FuturesOffers(futures, vehicles, maxDelayS, missing)
    case predictive: LoopTiming.Predictive =>
      PredictiveOffers(predictive, vehicles, maxDelayS, forecast, missing)
    case other => throw IllegalArgumentException(s"expected a loop that is not refused, got $other")

  def periodS: Double    = timing.periodS
  val steering: Steering = timing.steering

  /** Minimum time between two decisions, or between two commands if [[decidesFirst]], s. */
  val intervalS: Double = timing match
    case stream: LoopTiming.Stream => stream.periodS - stream.toleranceS
    case _                         => 0

  /** Whether a vehicle decides on every offer, so that decisions wait instead of offers. */
  val decidesFirst: Boolean = timing match
    case stream: LoopTiming.Stream => stream.decideThenPace
    case _: LoopTiming.Predictive  => false
    case _                         => true

  /** Longest time from a decision until its command takes effect, s. */
  def longestS: Double = LoopLanes.MostS + 1

  /** Number of past periods whose flight a reading or an image may need: from a reading to its decision, and
    * from the previous decision until its command takes effect.
    */
  val keptRows: Int =
    val kept = LoopLanes.readingS(timing, vehicles, maxDelayS) + 3 * maxDelayS + 2 * periodS + 0.5
    offers.rowsAhead + 2 + (kept / periodS).ceil.toInt

private[lanes] object LoopLanes:
  /** Latest time of a command's effect, s after the begin of its period. With up to a second and a half for
    * reading vehicles, times in grains stay within the range of integers.
    */
  val MostS = 6.0

  /** Longest time from the first reading of a view to its decision, s. */
  def readingS(timing: LoopTiming, vehicles: Int, maxDelayS: Double): Double =
    val inTurn = timing match
      case _: (LoopTiming.Stream | LoopTiming.Predictive) => 2
      case _                                              => vehicles
    inTurn * timing.asking.timeoutS.min(2 * maxDelayS)

/** Caches objects that are made for a longest delay, one for all links of about equal delay. The delay
  * determines how far a loop is computed ahead, and has no effect on results.
  *
  * @param make creates the object for a longest one-way delay, s
  */
private[lanes] final class BySlowest[K](make: Double => K):
  private val made = mutable.HashMap.empty[Double, K]

  def apply(links: Array[? <: Delays]): K =
    val slowestS = links.iterator.collect { case link: TabledDelays => link.maxS }.max
    val about    = Iterator.iterate(BySlowest.FastestS)(_ * 1.4).find(_ >= slowestS).get
    made.getOrElseUpdate(about, make(about))

private[lanes] object BySlowest:
  private val FastestS = 0.02
