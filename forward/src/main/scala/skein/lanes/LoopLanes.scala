package skein.lanes

import scala.collection.mutable
import skein.forward.{DelayTable, Delays, LoopTiming, Steering}
import skein.port.Moves
import skein.units.Expect

/** A loop for worlds with delays of their own: what it offers to whom, how it lets commands go, and for how
  * long vehicles have to remember. Mutable as its offers are: one per kernel.
  *
  * @param vehicles how many are asked
  * @param maxDelayS the longest one-way delay of any link flown over
  * @param shortCut whether regular stretches of `stream` are told by lanes; without, the same is told world
  *   by world
  */
private[lanes] final class LoopLanes(
    val timing: LoopTiming,
    vehicles: Int,
    val durationS: Double,
    maxDelayS: Double,
    shortCut: Boolean = true
):
  val offers: LaneOffers = timing match
    case stream: LoopTiming.Stream         => StreamOffers(stream, vehicles, durationS, shortCut)
    case sequential: LoopTiming.Sequential => SequentialOffers(sequential, vehicles)
    case futures: LoopTiming.Futures       => FuturesOffers(futures, vehicles, maxDelayS)
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
    case _                         => true

  /** A command is under way for so long at most, s. */
  def longestS: Double = 2 * LoopLanes.MostS

  /** Periods before, of which a reading may ask for the flight: those from a reading to its decision, and
    * from the decision before that to when its command acts.
    */
  val keptRows: Int =
    val kept = LoopLanes.readingS(timing, vehicles, maxDelayS) + 3 * maxDelayS + 2 * periodS + 0.5
    offers.rowsAhead + 2 + (kept / periodS).ceil.toInt

private[lanes] object LoopLanes:
  /** Times stay within what integers of grains can hold. */
  private val MostS = 3.5

  /** Of all questions of a round or task, each taking as long as it may. */
  private val MostInTurnS = 3.5

  /** From the first reading of a view to its decision. */
  private def readingS(timing: LoopTiming, vehicles: Int, maxDelayS: Double): Double =
    val inTurn = timing match
      case _: LoopTiming.Stream => 2
      case _                    => vehicles
    inTurn * LoopTiming.askingOf(timing).timeoutS.min(2 * maxDelayS)

  /** Why this loop does not fly over a link by lanes, for a person. */
  def refusal(timing: LoopTiming, vehicles: Int, link: Delays, model: LaneDynamics): Option[String] =
    link match
      case table: DelayTable => refusal(timing, vehicles, table.maxS, model)
      case _ => Some("worlds of their own fly by lanes where a link's delays do not come in stretches")

  private def refusal(
      timing: LoopTiming,
      vehicles: Int,
      maxDelayS: Double,
      model: LaneDynamics
  ): Option[String] =
    val steering = LoopTiming.steeringOf(timing)
    val timeoutS = LoopTiming.askingOf(timing).timeoutS
    val ofLoop   = timing match
      case stream: LoopTiming.Stream =>
        for
          _ <- Expect.that(!stream.asking.inOrder):
            "the lanes take answers as they come, and this loop in order"
          _ <- Expect.that(stream.asking.spreadS == 0):
            "the lanes ask all vehicles at once, and this loop spreads its questions"
          _ <- Expect.that(stream.patienceS > 0):
            "the lanes wait for the other vehicles' readings, and this loop does not"
        yield Vector(stream.patienceS, stream.toleranceS)
      case _: LoopTiming.Sequential | _: LoopTiming.Futures =>
        Expect
          .that(vehicles * timeoutS <= MostInTurnS):
            s"$vehicles questions in turn may take longer than the lanes can count"
          .map(_ => Vector.empty)
      case _ => Left("worlds with delays of their own fly by lanes under sequential, futures and stream")
    val refused =
      for
        _ <- Expect.that(model.fliesAlone):
          "worlds with delays of their own fly vehicle by vehicle with the quadrotor"
        _ <- Expect.that(steering.mostOutstanding == Moves.MostOutstanding):
          s"the lanes know ${Moves.MostOutstanding} moves in flight, and this loop has ${steering.mostOutstanding}"
        times <- ofLoop
        _     <- Expect.that(model.stepS <= LaneFlights.MOST_PIECE_S):
          s"the lanes fly steps of ${LaneFlights.MOST_PIECE_S} s at most, and the vehicle's last ${model.stepS} s"
        underWayS = times.headOption.getOrElse(0.0) + readingS(timing, vehicles, maxDelayS) + 2 * maxDelayS
        _ <- Expect.that(timing.periodS + underWayS + model.deadTimeS <= MostS):
          "a command may act later than the lanes can count"
        own = Vector(timing.periodS, timeoutS, steering.minIntervalS, steering.handoverS)
        _ <- Expect.that((own ++ times).forall(LaneViews.isWhole)):
          "the lanes count time in grains of 4 ns, and this loop's times are none"
      yield ()
    refused.left.toOption

/** One of a kind for links about as slow: how far a loop is looked ahead depends on it, and no result does.
  *
  * @param make for a longest one-way delay, s
  */
private[lanes] final class BySlowest[K](make: Double => K):
  private val made = mutable.HashMap.empty[Double, K]

  /** That for the slowest of these. */
  def apply(links: Array[? <: Delays]): K =
    val slowestS = links.iterator.collect { case table: DelayTable => table.maxS }.max
    val about    = Iterator.iterate(BySlowest.FastestS)(_ * 1.4).find(_ >= slowestS).get
    made.getOrElseUpdate(about, make(about))

private object BySlowest:
  private val FastestS = 0.02
