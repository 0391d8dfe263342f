package skein.lanes.loop

import scala.collection.mutable
import skein.forward.{Delays, RolloutAgent, LoopTiming, Steering, TabledDelays}

/** A loop for worlds with separate delays: its offers, its pacing of commands, and how long vehicles must
  * keep their history. Mutable as its offers are: one per kernel.
  *
  * @param vehicles number of vehicles that are read
  * @param maxDelayS the longest one-way delay of any link
  * @param sees whether images are taken, which need the vehicles' positions at any time
  * @param shortCut whether SIMD computes regular stretches of `stream`; if false, each world is computed
  *   separately, with equal results
  */
private[lanes] final class LoopLanes(
    val timing: LoopTiming,
    vehicles: Int,
    val durationS: Double,
    maxDelayS: Double,
    val sees: Boolean = false,
    shortCut: Boolean = true
):
  /** The model that predicts the vehicles, if the loop predicts. */
  private val predictor: Option[LanePredictor] = timing match
    case predictive: LoopTiming.Predictive => LanePredictor.of(predictive.predictor).toOption
    case _                                 => None

  /** Null where decisions use the readings themselves. */
  val forecast: LaneForecast =
    predictor.fold(null)(by => LaneForecast(timing.periodS, vehicles, by.deadTimeS))

  /** Sets the model and source of readings of a vehicle, if the loop predicts. */
  def carryForward(vehicle: Int, agent: RolloutAgent, read: LaneVehicles): Unit =
    for by <- predictor do forecast.follow(vehicle, by.alone(agent), read)

  val offers: LaneOffers = timing match
    case stream: LoopTiming.Stream         => StreamOffers(stream, vehicles, durationS, maxDelayS, shortCut)
    case sequential: LoopTiming.Sequential => SequentialOffers(sequential, vehicles)
    case futures: LoopTiming.Futures       => FuturesOffers(futures, vehicles, maxDelayS)
    case predictive: LoopTiming.Predictive => PredictiveOffers(predictive, vehicles, maxDelayS, forecast)
    case other => throw IllegalArgumentException(s"expected a loop that is not refused, came $other")

  def periodS: Double    = timing.periodS
  val steering: Steering = LoopTiming.steeringOf(timing)

  /** Least time between two decisions, or between two commands if it decides first, s. */
  val intervalS: Double = timing match
    case stream: LoopTiming.Stream => stream.periodS - stream.toleranceS
    case _                         => 0

  /** Whether a vehicle decides at every offer, and decisions wait instead of offers. */
  val decidesFirst: Boolean = timing match
    case stream: LoopTiming.Stream => stream.decideThenPace
    case _: LoopTiming.Predictive  => false
    case _                         => true

  /** Longest time for which a command is on its way, s. */
  def longestS: Double = LoopLanes.MostS + 1

  /** Number of earlier periods whose flight a reading or an image may need: those from a reading to its
    * decision, and from the decision before that until its command takes effect.
    */
  val keptRows: Int =
    val kept = LoopLanes.readingS(timing, vehicles, maxDelayS) + 3 * maxDelayS + 2 * periodS + 0.5
    offers.rowsAhead + 2 + (kept / periodS).ceil.toInt

private[lanes] object LoopLanes:
  /** Longest time, s, after a period's begin at which a command may act: with the second and a half within
    * which vehicles are read, it stays within the range of integers in grains.
    */
  val MostS = 6.0

  /** Longest time from the first reading of a view to its decision, s. */
  def readingS(timing: LoopTiming, vehicles: Int, maxDelayS: Double): Double =
    val inTurn = timing match
      case _: (LoopTiming.Stream | LoopTiming.Predictive) => 2
      case _                                              => vehicles
    inTurn * LoopTiming.askingOf(timing).timeoutS.min(2 * maxDelayS)

/** Caches an object made for links of about equal delay: how far a loop is computed ahead depends on it, and
  * no result does.
  *
  * @param make makes one for a longest one-way delay, s
  */
private[lanes] final class BySlowest[K](make: Double => K):
  private val made = mutable.HashMap.empty[Double, K]

  def apply(links: Array[? <: Delays]): K =
    val slowestS = links.iterator.collect { case link: TabledDelays => link.maxS }.max
    val about    = Iterator.iterate(BySlowest.FastestS)(_ * 1.4).find(_ >= slowestS).get
    made.getOrElseUpdate(about, make(about))

private[lanes] object BySlowest:
  private val FastestS = 0.02
