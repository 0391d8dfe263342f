package skein.report

import java.util.Locale
import skein.loop.LoopKind
import skein.measure.{Compared, Distribution, FlightSet, FlightSummary, Published, TimingObservation, Twin}
import skein.record.EventKind
import skein.units.Decimals.{brief, fixed, signed}

/** The tables of a report, for the terminal and for the page alike. */
object SummaryTables:

  def distances(set: FlightSet): TextTable =
    TextTable(
      Vector("<loop", "<link", "flown s", "closest m", "at s") ++
        Vector("last 10 s m", "sd", "<min … max", "vs paused") ++
        Vector("paper m", "<min … max", "closest m"),
      set.flights.map: summary =>
        val ours = summary.distance match
          case Some(curve) =>
            val last = curve.lastTenSeconds.fold(Vector("< 10 s", "", "")): last =>
              Vector(
                last.mean.fixed(2),
                last.sd.fixed(2),
                s"${last.least.fixed(1)} … ${last.most.fixed(1)}"
              )
            Vector(
              summary.flownS.fixed(1),
              curve.closest._2.fixed(2),
              curve.closest._1.fixed(1)
            ) ++ last :+
              againstTruth(summary, set.deviation(summary))
          case None => Vector(if summary.noResult.isDefined then "" else "0", "", "", "", "", "", "")
        val hasTenSeconds = summary.distance.exists(_.lastTenSeconds.isDefined)
        val paper         = summary.published.filter(_ => hasTenSeconds).flatMap(_.distance) match
          case Some(published) =>
            Vector(
              published.mean.fixed(2),
              s"${published.least.fixed(1)} … ${published.most.fixed(1)}",
              published.closest.fixed(2)
            )
          case None => Vector("", "", "")
        Vector(summary.name, summary.flight.link) ++ ours ++ paper
    )

  /** Compares a flight with the paused flight, or states that it cannot be compared. */
  private[report] def againstTruth(flight: FlightSummary, share: Option[Double]): String =
    if flight.starved.isDefined then "starved" else share.fold("")(share => s"${(share * 100).signed(1)} %")

  /** Ages and times since moves in ms as `mean/p50/p99`, each with the paper's mean, and the mean true ages;
    * by the role of the deciding vehicle. Without one of the paper's flights there is no comparison.
    */
  def observations(set: FlightSet): TextTable =
    val paper = Option.when(set.flights.exists(_.published.nonEmpty))("paper").toVector
    val shown = FlightSummary.observations(set.flights)
    val ages  = Vector("true own") ++ Option.when(shown.exists(_.isOfOpponent))("opp.'s")
    TextTable(
      Vector("<loop", "<link", "<for") ++ shown.map(header).flatMap(_ +: paper) ++ ages,
      for
        summary <- set.flights
        role    <- summary.roles
      yield
        val published = summary.published.map(_.observedMs)
        val observed  = shown.flatMap: observation =>
          role.observedMs.get(observation).fold("")(ms =>
            s"${ms.mean.brief}/${ms.median.brief}/${ms.p99.brief}"
          ) +: paper.map(_ =>
            published.fold("")(means => Published.ofRole(means(observation), role.role).brief)
          )
        Vector(summary.name, summary.flight.link, role.role) ++ observed ++
          Vector(role.ownTrueAgeMs, role.opponentTrueAgeMs)
            .take(ages.size)
            .map(_.fold("")(age => age.mean.brief))
    )

  private def header(observation: TimingObservation) = observation match
    case TimingObservation.OwnAge            => "own age"
    case TimingObservation.OpponentAge       => "opp.'s age"
    case TimingObservation.SinceOwnMove      => "own move"
    case TimingObservation.SinceOpponentMove => "opp.'s move"

  /** Counts of work and of problems; of the rarer kinds of events, only those that occurred. */
  def counts(set: FlightSet): TextTable =
    val always = Set(EventKind.Dropped, EventKind.Skipped, EventKind.TimedOut)
    val kinds  =
      EventKind.values.toVector.filter(kind => always(kind) || set.flights.exists(_.count(kind) > 0))
    TextTable(
      Vector("<loop", "<link", "readings", "decisions", "commands") ++ kinds.map(label),
      set.flights.map: summary =>
        Vector(summary.name, summary.flight.link) ++
          Vector(summary.readings, summary.decisions, summary.commands).map(_.toString) ++
          kinds.map(summary.count(_).toString)
    )

  /** Image recognition: number of images, duration of recognition, age at the decision, and the error of the
    * estimate at the exposure.
    */
  def seen(flights: Seq[FlightSummary]): TextTable =
    def spread(values: Option[Distribution], digits: Int) =
      values.fold(Vector("", ""))(all => Vector(all.median.fixed(digits), all.p99.fixed(digits)))
    TextTable(
      Vector("<loop", "<link", "<vehicle", "<looks for", "images", "found") ++
        Vector("took ms p50", "p99", "age ms p50", "p99", "off m p50", "p99"),
      for
        flight <- flights.toVector
        seen   <- flight.seeing
      yield Vector(
        flight.name,
        flight.flight.link,
        seen.eye.vehicle,
        seen.eye.target,
        seen.images.fold("")(_.toString)
      ) ++
        Vector(seen.detections.size.toString) ++ spread(seen.tookMs, 0) ++ spread(seen.agesMs, 0) ++
        spread(seen.errorsM, 2)
    )

  val seenNote: String =
    "Images: searched until the last detection, if there was one. Found: detections that were used. " +
      "Took: duration of recognition. Age: from the exposure to each decision made from the detection. " +
      "Off: distance of the estimate for the moment of the exposure from the truth."

  /** Live flights compared with their virtual twins: Kolmogorov-Smirnov distances of the decisions'
    * observations, by role, and the difference of the converged distances.
    */
  def twins(set: FlightSet): TextTable =
    val columns = Twin.columns(set.twins)
    val unit    = set.twins.flatMap(_.live.headlineOf).map(_.unit).distinct match
      case Vector(one) => one
      case _           => ""
    TextTable(
      Vector("<loop", "<link", "seed", "<virtual") ++ columns.map(_._3) ++
        Vector(s"live $unit".trim, s"virtual $unit".trim, "difference", "<flown otherwise"),
      set.twins.map: twin =>
        val flight = twin.live.flight
        Vector(twin.live.name, flight.link, flight.seed.toString, twin.seeds) ++
          columns.map((role, quantity, _) =>
            twin.find(role, quantity).fold("")(one => one.distance.fixed(2))
          ) ++
          twin.converged.fold(Vector("", ""))((live, virtual) => Vector(live.fixed(2), virtual.fixed(2))) ++
          Vector(
            twin.difference.fold("")(share => s"${(share * 100).signed(1)} %"),
            twin.unlike
          )
    )

  /** Remarks on single flights, one line each. */
  def remarks(set: FlightSet): Vector[String] =
    def each[A](of: FlightSummary => Iterable[A])(line: (String, A) => String) =
      for
        summary <- set.all
        found   <- of(summary)
      yield line(summary.flight.id, found)
    each(_.noResult)((id, none) => s"$id has no result: ${none.why}") ++
      cutShort(set) ++
      each(_.starved)((id, why) => s"$id was starved, and is not compared with other flights: $why") ++
      each(_.paused)((id, span) =>
        s"$id was paused for ${span.toSeconds.fixed(1)} s: its vehicles hovered and " +
          "nothing was decided; its times and distances include this, so it is not compared with other flights"
      ) ++
      each(_.imageless)((id, camera) => s"$id: $camera") ++
      unknown(set) ++ waiting(set)

  /** A line for each flight that ended early. */
  private def cutShort(set: FlightSet): Vector[String] =
    for
      summary <- set.all if summary.noResult.isEmpty
      reason  <- summary.cutShort
    yield
      val flown = s"${summary.flownS.fixed(1)} of ${summary.flight.duration.toSeconds.brief} s"
      s"${summary.flight.id} was cut short, after $flown: $reason"

  /** A line for each unknown scenario. */
  private def unknown(set: FlightSet): Vector[String] =
    set.all.filter(_.scenario.isEmpty).groupBy(_.flight.nameOfScenario).toVector.sortBy(_._1).map:
      (name, flights) =>
        s"the scenario $name of ${flights.map(_.flight.id).mkString(", ")} is not known to this program: " +
          "its measures, limits and pictures are left out; the program that flew it has them"

  /** A line for each flight whose moves waited for answers: predicting loops gain from sending more of them.
    */
  private def waiting(set: FlightSet): Vector[String] =
    for
      summary <- set.all
      if Predicting(summary.flight.loop)
      roundTrip <- summary.roundTripsMs.map(_.median)
      apartMs  = 1000 * summary.flownS * summary.tracks.size / summary.commands
      periodMs = summary.flight.period.toMillis
      if roundTrip > periodMs && apartMs > WaitingFrom * periodMs && apartMs.isFinite
    yield s"${summary.flight.id} moved each vehicle every ${apartMs.brief} ms, not every ${periodMs.brief}: a " +
      s"move waits for the answer to an earlier one, and a round trip takes ${roundTrip.brief} ms. With " +
      "--moves-in-flight 6 more are under way at once; the guide to AirSim says when that is safe"

  private val Predicting = Set(LoopKind.Predictive.label, LoopKind.Plan.label)

  /** Mean interval between moves, in periods, from which a remark is made: a few moves are always late. */
  private val WaitingFrom = 1.25

  val twinsNote: String =
    "Kolmogorov-Smirnov distances between live and virtual decisions, by role: of the age of the " +
      "vehicle's own data, and of the time since its last move. 0: distributed alike; 1: no overlap. " +
      s"Times within ${Compared.WithinMs} ms count as equal. Then the scenario's first measure of both flights"

  /** An event kind in words: `TimedOut` as `timed out`. */
  def label(kind: EventKind): String =
    kind.toString.replaceAll("(?<=.)([A-Z])", " $1").toLowerCase(Locale.ROOT)
