package skein.report

import skein.measure.{DistanceCurve, Distribution, FlightSet, FlightSummary, ScenarioNames}
import skein.units.Decimals.fixed

/** Whether the timing of flights is good enough, in one sentence, according to the criterion of the AirSim
  * guide.
  *
  * With a `paused` flight it is measured: a loop may deviate by [[Limit]] from the paused flight, the margin
  * of [[skein.optimise.LatencyBudget]]. Without one it is estimated: a vehicle moves from where it was read
  * until the command based on that reading arrives, and this distance may be [[Limit]] of the distance
  * between vehicles. For a loop that predicts, the predictions' median error is taken instead.
  */
object TimingVerdict:
  /** A fraction of the paused flight's value, or of the distance between vehicles. */
  val Limit = 0.05

  /** The sentence; None if only `paused` was run. */
  def sentence(set: FlightSet): Option[String] =
    val flights    = set.flights.filterNot(_.flight.isPaused)
    val scenarioOf = ScenarioNames.among(flights)
    val all        = flights
      .groupBy(one => (one.name, one.flight.link, scenarioOf(one), one.flight.clock))
      .toVector
      .sortBy((_, same) => flights.indexOf(same.head))
      .map { case ((name, link, scenario, _), same) =>
        Judged(if scenario.isEmpty then name else s"$name in $scenario", link, of(set, same))
      }
    Option.when(all.nonEmpty)(said(all))

  /** The flights of one loop over one link in one scenario, with the verdict if there is one. */
  private final case class Judged(name: String, link: String, verdict: Option[Verdict])

  /** @param share deviation as a fraction of the paused flight's value, or of the distance between vehicles
    * @param why the meaning of the share, in words
    */
  private final case class Verdict(isMeasured: Boolean, share: Double, why: String):
    def word: String = (if isMeasured then "" else "probably ") + (if share > Limit then "bad" else "good")

  private def said(all: Vector[Judged]): String =
    val words = Vector("bad", "good", "probably bad", "probably good")
    val parts = words.flatMap: word =>
      val those = all.filter(_.verdict.exists(_.word == word))
      those.flatMap(_.verdict).maxByOption(_.share).map: worst =>
        val most = if those.size > 1 then "at worst " else ""
        s"$word for ${named(those)} ($most${worst.why})"
    val judged = Option.when(parts.nonEmpty):
      s"With ${(100 * Limit).fixed(0)} % as the limit, timing is ${parts.mkString(" and ")}"
    val (nothing, are) = (all.filter(_.verdict.isEmpty), all.count(_.verdict.isEmpty) > 1)
    val unjudged       =
      Option.when(nothing.nonEmpty)(s"${named(nothing)} ${if are then "are" else "is"} not judged")
    (judged ++ unjudged).mkString("", "; ", ".")

  /** Loops by their links: `futures and stream over direct and vpn`. */
  private def named(those: Vector[Judged]): String =
    val loops =
      those.map(_.link).distinct.map(link => (link, those.filter(_.link == link).map(_.name).distinct))
    loops.map(_._2).distinct.map(same =>
      s"${listed(same)} over ${listed(loops.collect { case (link, `same`) => link })}"
    ).mkString(", ")

  private def listed(words: Vector[String]): String =
    val first = words.dropRight(1)
    (Option.when(first.nonEmpty)(first.mkString(", ")) ++ words.lastOption).mkString(" and ")

  /** @param same the flights of one loop over one link in one scenario
    * @return None if no flight has a result on a machine that was fast enough, or there are too few data
    */
  private def of(set: FlightSet, same: Vector[FlightSummary]): Option[Verdict] =
    val sound = same.filter(one => one.noResult.isEmpty && one.starved.isEmpty)
    off(sound.flatMap(set.deviation))
      .map(share => Verdict(true, share, s"${percent(share)} off the truth"))
      .orElse(sound.headOption.flatMap(estimated))

  /** How far flights are off, whichever way: deviations of different signs do not make good for one another.
    */
  private[report] def off(shares: Vector[Double]): Option[Double] =
    Distribution.of(shares.map(_.abs)).map(_.mean)

  private def estimated(flight: FlightSummary): Option[Verdict] =
    for
      apartM <- separationM(flight) if apartM > 0
      found  <- unforeseen(flight, apartM).orElse(unseen(flight, apartM))
    yield found

  private def unforeseen(flight: FlightSummary, apartM: Double): Option[Verdict] =
    for
      errors <- flight.predictions.flatMap(all => (all.own ++ all.others).errors)
      share = errors.median / apartM
    yield Verdict(
      false,
      share,
      s"predictions are off by ${errors.median.fixed(2)} m in the median, " +
        s"${percent(share)} of the ${apartM.fixed(1)} m between vehicles"
    )

  private def unseen(flight: FlightSummary, apartM: Double): Option[Verdict] =
    for
      age    <- flight.commandAgesMs.map(_.mean)
      trip   <- flight.roundTripsMs.map(_.median)
      speeds <- Distribution.of(flight.tracks.flatMap(one =>
        Distribution.of(one.velocitiesNed.map(_.norm))
      ).map(_.mean))
      lateMs = age + trip / 2
      flownM = speeds.most * lateMs / 1000
      share  = flownM / apartM
    yield Verdict(
      false,
      share,
      s"a vehicle flies on for ${lateMs.fixed(0)} ms and ${flownM.fixed(2)} m, ${percent(share)} of the " +
        s"${apartM.fixed(1)} m between vehicles, before a command answers to what was read"
    )

  /** The smallest of the pairwise median distances between vehicles, m. */
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

  /** Maximum number of vehicles of a large team that are compared. */
  private val MostCompared = 8

  private def percent(share: Double) = s"${(100 * share).fixed(1)} %"
