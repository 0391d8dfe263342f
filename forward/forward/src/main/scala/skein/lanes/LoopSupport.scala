package skein.lanes

import skein.forward.{Asking, Delays, LoopTiming, TabledDelays}
import skein.lanes.loop.{LaneAgents, LaneFlights, LaneViews, LoopLanes}
import skein.units.Expect

/** Checks which loops SIMD supports with separate delays in every world. */
private[lanes] object LoopSupport:
  import LoopLanes.{MostS, readingS}

  /** Maximum total time of a round's or task's requests, each as slow as the link allows, s. */
  private val MostInTurnS = 3.5

  /** The reason why SIMD does not support this loop over a link, for the user; None if it does. */
  def refusal(timing: LoopTiming, models: Vector[LaneDynamics], link: Delays): Option[String] =
    link match
      case tabled: TabledDelays => refusal(timing, models, tabled.maxS)
      case _                    => Some("SIMD supports delays of each world's own only from tables")

  private def refusal(
      timing: LoopTiming,
      models: Vector[LaneDynamics],
      maxDelayS: Double
  ): Option[String] =
    val vehicles = models.size
    val stepS    = models.map(_.stepS).max
    val steering = timing.steering
    val timeoutS = timing.asking.timeoutS
    val ofLoop   = timing match
      case stream: LoopTiming.Stream =>
        for
          _ <- asksAtOnce(stream.asking)
          _ <- Expect.that(stream.patienceS > 0):
            "SIMD supports only loops that wait for the other vehicles' readings"
        yield Vector(stream.patienceS, stream.toleranceS)
      case _: LoopTiming.Sequential | _: LoopTiming.Futures =>
        Expect
          .that(readingS(timing, vehicles, maxDelayS) <= MostInTurnS):
            s"$vehicles questions in turn may take longer than SIMD can represent"
          .map(_ => Vector.empty)
      case predictive: LoopTiming.Predictive =>
        // Decisions are due half-way between two requests.
        asksAtOnce(predictive.asking).map(_ => Vector(predictive.periodS / 2))
      case _: LoopTiming.Paused => Left("worlds that stand still while it is decided meet no delays")
    val refused =
      for
        _ <- Expect.that(models.forall(_.fliesAlone)):
          "worlds with delays of their own fly vehicle by vehicle with the quadrotor"
        _ <- Expect.that(steering.mostOutstanding >= LaneAgents.LEAST_UNDER_WAY):
          s"with ${steering.mostOutstanding} move in flight, a vehicle is commanded once"
        times <- ofLoop
        _     <- Expect.that(stepS <= LaneFlights.MOST_PIECE_S):
          s"SIMD supports steps of ${LaneFlights.MOST_PIECE_S} s at most, and the vehicle's take $stepS s"
        underWayS = times.headOption.getOrElse(0.0) + readingS(timing, vehicles, maxDelayS) + 2 * maxDelayS
        _ <- Expect.that(timing.periodS + underWayS + models.map(_.deadTimeS).max <= MostS):
          "a command may take effect later than SIMD can represent"
        own = Vector(timing.periodS, timeoutS, steering.minIntervalS, steering.handoverS)
        _ <- Expect.that((own ++ times).forall(LaneViews.isWhole)):
          "SIMD counts time in units of 4 ns, and a time of this loop is no multiple of them"
      yield ()
    refused.left.toOption

  private def asksAtOnce(asking: Asking): Either[String, Unit] =
    for
      _ <- Expect.that(!asking.inOrder):
        "SIMD takes answers in the order of arrival, and this loop in that of its requests"
      _ <- Expect.that(asking.spreadS == 0):
        "SIMD supports only loops that read all vehicles simultaneously"
    yield ()
