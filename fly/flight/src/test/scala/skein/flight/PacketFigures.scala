package skein.flight

import skein.loop.LoopKind
import skein.measure.FlightSummary
import skein.record.{CommandOutcome, Recording}
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*
import skein.units.Decimals.{fixed, signed}

/** What plans in packets do for each flight of the paper's duel over a link that loses packets: deviation
  * from the paused truth, and the longest wait for a command's answer.
  *
  * @param first the first seed
  */
@main def packetFigures(first: Int, seeds: Int, links: String*): Unit =
  given Scenarios                                                    = Scenarios.ours
  def settings(loop: LoopKind, link: LatencyProfile, plans: Boolean) = FlySettings(
    List(loop),
    List(link),
    duration = Span.ofSeconds(60),
    period = Span.ofMillis(100),
    seed = first,
    planInPacket = plans
  )
  def flown[A](settings: FlySettings, count: Int)(use: Recording => A) =
    VirtualFlights.inParallel(
      settings,
      Vector.tabulate(count)(number => settings.plans.head.copy(seed = first + number))
    )(flight => (flight.landed.plan.seed, flight.landed.outcome, use(flight.recorder.recording)))
  def distance(recording: Recording) = FlightSummary.of(recording).headline

  val truth = flown(settings(LoopKind.Paused, LatencyProfile.none, plans = false), 1)(distance)
    .flatMap(_.toOption)
    .flatMap(_._3)
    .head
  println(s"truth ${truth.fixed(3)} m")
  for text <- links do
    val link    = LatencyProfile.parse(text, _ => Left("no file")).fold(e => sys.error(e.message), identity)
    val flights = flown(settings(LoopKind.Predictive, link, plans = true), seeds): recording =>
      val sent  = recording.commands.map(one => (one.vehicle, one.sequence) -> one.sentAt).toMap
      val waits = recording.acknowledgements
        .filter(_.outcome == CommandOutcome.Done)
        .map(one => one.endedAt.since(sent((one.vehicle, one.command))).toSeconds)
      val failed = recording.acknowledgements.count(_.outcome != CommandOutcome.Done)
      (distance(recording), waits.maxOption.getOrElse(0.0), failed)
    flights.foreach:
      case Left(missing)                                       => println(missing.message)
      case Right((seed, outcome, (distance, longest, failed))) =>
        val off = distance.fold("no distance")(m => s"${(100 * (m / truth - 1)).signed(1)} %")
        println(
          s"$text, seed $seed: $off, longest answer ${longest.fixed(2)} s, $failed unanswered, $outcome"
        )
