package skein.report

import skein.measure.{DistanceCurve, Distribution, FlightSet, FlightSummary}
import skein.units.Decimals.fixed

/** Whether the timing of flights is good enough, in one sentence, by the criterion of the AirSim guide.
  *
  * With a `paused` flight it is measured: a loop may deviate by [[Limit]] from the truth, the margin of
  * [[skein.optimise.LatencyBudget]]. Without one it is estimated: a vehicle moves from where it was read
  * until the command based on that reading arrives, and this distance may be [[Limit]] of the distance
  * between vehicles. For a loop that predicts, the predictions' median error is taken instead.
  */
object TimingVerdict:
  /** A fraction of the truth, or of the distance between vehicles. */
  val Limit = 0.05

  /** The sentence; None where only `paused` was run. */
  def sentence(set: FlightSet): Option[String] =
    val flights = set.flights.filterNot(_.flight.isPaused)
    val said    = flights.groupBy(one => (one.name, one.flight.link)).toVector.sortBy((_, same) =>
      flights.indexOf(same.head)
    ).map: (key, same) =>
      s"${key._1} over ${key._2} is ${of(set, same)}"
    Option.when(said.nonEmpty)(
      s"Timing, with ${(100 * Limit).fixed(0)} % as the limit: ${said.mkString("; ")}."
    )

  /** @param same flights of one loop over one link */
  private def of(set: FlightSet, same: Vector[FlightSummary]): String =
    val measured = Distribution.of(same.flatMap(set.deviation)).map(_.mean)
    same.head match
      case one if one.noResult.isDefined || one.starved.isDefined => "not judged"
      case one                                                    =>
        measured
          .map(share => s"${word(share.abs)}, ${percent(share.abs)} off the truth")
          .orElse(estimated(one))
          .getOrElse("not judged: too little was read, or there is one vehicle alone and no paused flight")

  private def estimated(flight: FlightSummary): Option[String] =
    for
      apartM <- separationM(flight) if apartM > 0
      text   <- unforeseen(flight, apartM).orElse(unseen(flight, apartM))
    yield text

  private def unforeseen(flight: FlightSummary, apartM: Double): Option[String] =
    for
      errors <- flight.predictions.flatMap(all => (all.own ++ all.others).errors)
      share = errors.median / apartM
    yield s"probably ${word(share)}: its predictions are off by ${errors.median.fixed(2)} m in the median, " +
      s"${percent(share)} of the ${apartM.fixed(1)} m between vehicles"

  private def unseen(flight: FlightSummary, apartM: Double): Option[String] =
    for
      age    <- flight.commandAgesMs.map(_.mean)
      trip   <- flight.roundTripsMs.map(_.median)
      speeds <- Distribution.of(flight.tracks.flatMap(one =>
        Distribution.of(one.velocitiesNed.map(_.norm))
      ).map(_.mean))
      lateMs = age + trip / 2
      flownM = speeds.most * lateMs / 1000
      share  = flownM / apartM
    yield s"probably ${word(share)}: a vehicle flies on for ${lateMs.fixed(0)} ms and ${flownM.fixed(2)} m, " +
      s"${percent(share)} of the ${apartM.fixed(1)} m between vehicles, before a command answers to what was read"

  /** The median distance between the two vehicles that are nearest by it. */
  private def separationM(flight: FlightSummary): Option[Double] =
    val near  = flight.tracks.take(MostCompared)
    val apart =
      for
        (one, index) <- near.zipWithIndex
        other        <- near.drop(index + 1)
        curve        <- DistanceCurve.between(one, other)
        metres       <- Distribution.of(curve.points.map(_._2))
      yield metres.median
    apart.minOption

  /** Most vehicles of a large team that are compared. */
  private val MostCompared = 8

  private def word(share: Double)    = if share > Limit then "bad" else "good"
  private def percent(share: Double) = s"${(100 * share).fixed(1)} %"
