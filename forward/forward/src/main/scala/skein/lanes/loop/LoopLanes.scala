package skein.lanes.loop

import scala.collection.mutable
import skein.forward.{Delays, RolloutAgent, LoopTiming, Steering, TabledDelays}

/** A loop for worlds with delays of their own: what it offers to whom, how it lets commands go, and for how
  * long vehicles have to remember. Mutable as its offers are: one per kernel.
  *
  * @param vehicles how many are asked
  * @param maxDelayS the longest one-way delay of any link flown over
  * @param sees whether images are taken, for which vehicles are looked at whenever it is
  * @param shortCut whether regular stretches of `stream` are told by lanes; without, the same is told world
  *   by world
  */
private[lanes] final class LoopLanes(
    val timing: LoopTiming,
    vehicles: Int,
    val durationS: Double,
    maxDelayS: Double,
    val sees: Boolean = false,
    shortCut: Boolean = true
):
  /** How the vehicles' readings are carried forward, if they are. */
  private val predictor: Option[LanePredictor] = timing match
    case predictive: LoopTiming.Predictive => LanePredictor.of(predictive.predictor).toOption
    case _                                 => None

  /** Null where decisions go by the readings themselves. */
  val forecast: LaneForecast =
    predictor.fold(null)(by => LaneForecast(timing.periodS, vehicles, by.deadTimeS))

  /** From now on a vehicle's readings are carried forward, if the loop does. */
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

  /** Between two decisions, or between two commands if it decides first, s. */
  val intervalS: Double = timing match
    case stream: LoopTiming.Stream => stream.periodS - stream.toleranceS
    case _                         => 0

  /** Whether a vehicle decides at every offer, and what waits is the decision. */
  val decidesFirst: Boolean = timing match
    case stream: LoopTiming.Stream => stream.decideThenPace
    case _: LoopTiming.Predictive  => false
    case _                         => true

  /** A command is under way for so long at most, s. */
  def longestS: Double = 2 * LoopLanes.MostS

  /** Periods before, of which a reading or an image may ask for the flight: those from a reading to its
    * decision, and from the decision before that to when its command acts.
    */
  val keptRows: Int =
    val kept = LoopLanes.readingS(timing, vehicles, maxDelayS) + 3 * maxDelayS + 2 * periodS + 0.5
    offers.rowsAhead + 2 + (kept / periodS).ceil.toInt

private[lanes] object LoopLanes:
  /** Times stay within what integers of grains can hold. */
  val MostS = 3.5

  /** From the first reading of a view to its decision. */
  def readingS(timing: LoopTiming, vehicles: Int, maxDelayS: Double): Double =
    val inTurn = timing match
      case _: (LoopTiming.Stream | LoopTiming.Predictive) => 2
      case _                                              => vehicles
    inTurn * LoopTiming.askingOf(timing).timeoutS.min(2 * maxDelayS)

/** One of a kind for links about as slow: how far a loop is looked ahead depends on it, and no result does.
  *
  * @param make for a longest one-way delay, s
  */
private[lanes] final class BySlowest[K](make: Double => K):
  private val made = mutable.HashMap.empty[Double, K]

  /** That for the slowest of these. */
  def apply(links: Array[? <: Delays]): K =
    val slowestS = links.iterator.collect { case link: TabledDelays => link.maxS }.max
    val about    = Iterator.iterate(BySlowest.FastestS)(_ * 1.4).find(_ >= slowestS).get
    made.getOrElseUpdate(about, make(about))

private[lanes] object BySlowest:
  private val FastestS = 0.02
