package skein.lanes

import skein.forward.{Asking, Delays, LoopTiming, TabledDelays}
import skein.lanes.loop.{LaneAgents, LaneFlights, LanePredictor, LaneViews, LoopLanes}
import skein.units.Expect

/** Checks which loops SIMD supports with separate delays in every world. */
private[lanes] object LoopSupport:
  import LoopLanes.{MostS, readingS}

  /** Maximum total time of a round's or task's requests, each as slow as the link allows, s. */
  private val MostInTurnS = 3.5

  /** The reason why SIMD does not support this loop over a link, for the user; None if it does. */
  def refusal(timing: LoopTiming, vehicles: Int, link: Delays, model: LaneDynamics): Option[String] =
    link match
      case tabled: TabledDelays => refusal(timing, vehicles, tabled.maxS, model)
      case _                    => Some("worlds of their own fly by lanes where delays come from tables")

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
          _ <- asksAtOnce(stream.asking)
          _ <- Expect.that(stream.patienceS > 0):
            "the lanes wait for the other vehicles' readings, and this loop does not"
        yield Vector(stream.patienceS, stream.toleranceS)
      case _: LoopTiming.Sequential | _: LoopTiming.Futures =>
        Expect
          .that(readingS(timing, vehicles, maxDelayS) <= MostInTurnS):
            s"$vehicles questions in turn may take longer than the lanes can count"
          .map(_ => Vector.empty)
      case predictive: LoopTiming.Predictive =>
        for
          _ <- asksAtOnce(predictive.asking)
          _ <- LanePredictor.of(predictive.predictor)
        // Decisions are due half-way between two requests.
        yield Vector(predictive.periodS / 2)
      case _: LoopTiming.Paused => Left("worlds that stand still while it is decided meet no delays")
    val refused =
      for
        _ <- Expect.that(model.fliesAlone):
          "worlds with delays of their own fly vehicle by vehicle with the quadrotor"
        _ <- Expect.that(steering.mostOutstanding >= LaneAgents.LEAST_UNDER_WAY):
          s"with ${steering.mostOutstanding} move in flight, a vehicle is commanded once"
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

  private def asksAtOnce(asking: Asking): Either[String, Unit] =
    for
      _ <- Expect.that(!asking.inOrder):
        "the lanes take answers as they come, and this loop in order"
      _ <- Expect.that(asking.spreadS == 0):
        "the lanes ask all vehicles at once, and this loop spreads its questions"
    yield ()
