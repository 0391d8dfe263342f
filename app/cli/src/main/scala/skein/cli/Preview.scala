package skein.cli

import scala.util.Try
import skein.flight.{VirtualFlightResult, VirtualFlights, WarmUp}
import skein.loop.FlightOutcome
import skein.measure.RecordedTracks
import skein.report.{Report, Verdict}
import skein.scenario.{Result, Scenario, Scenarios, Tracks}
import skein.settings.{FlightPlan, FlySettings, OutsidePolicy}
import skein.units.*
import skein.units.Decimals.fixed

/** First results of live flights: simulates their virtual twins beforehand, provided that this takes little
  * time. These twins are not simulated again afterwards.
  */
private[cli] object Preview:

  /** Time after which no further flight is started. */
  val AtMost: Span = Span.ofSeconds(6)

  type Flown = Map[FlightPlan, VirtualFlightResult]

  /** Whether a flight would end within [[AtMost]] at the mean speed of the warm-up's flights.
    *
    * @param flights number of flights of the warm-up
    * @param took duration of all of them
    */
  def fits(flights: Int, took: Span, duration: Span): Boolean =
    val warmed = duration.min(WarmUp.Flown).toSeconds * flights
    flights > 0 && took.toSeconds * duration.toSeconds <= AtMost.toSeconds * warmed

  /** Whether a flight's twin can be simulated before the live flight: not if another process decides, during
    * whose decisions virtual time stands still.
    */
  def isPossible(plan: FlightPlan): Boolean =
    plan.solver.isEmpty && !plan.policy.exists(policy => OutsidePolicy.decides(policy.file))

  /** Simulates twins on all cores, in their order, and prints a line for each as it ends. Blocks.
    *
    * @param say prints a line
    * @return the completed flights; failed ones are simulated again later, and reported then
    */
  def fly(settings: FlySettings, twins: Vector[FlightPlan], clock: Clock)(say: String => Unit)(using
      Scenarios
  ): Flown =
    val until = clock.now() + AtMost
    val ended = VirtualFlights
      .eachInParallel(twins): plan =>
        if clock.now() >= until then Left("no time is left")
        else
          VirtualFlights.fly(settings, plan).map: flown =>
            line(settings.scenario, plan, flown).foreach(say)
            plan -> flown
      .flatMap(_.toOption)
      .filter(_._2.landed.outcome == FlightOutcome.Completed)
    if ended.size == twins.size then
      Verdict.sentences(Report.of(ended.map(_._2.recorder.recording)).deviations).foreach(say)
    ended.toMap

  /** A line with the first measure of a flight; None if the scenario's code fails, which the report explains.
    */
  private def line(scenario: Scenario, plan: FlightPlan, flown: VirtualFlightResult): Option[String] =
    for
      tracks   <- Tracks.of(RecordedTracks.of(flown.recorder.recording))
      measured <- Try(Result.of(scenario, tracks).measured).toOption.flatMap(_.headOption)
      value    <- measured.value
    yield s"in virtual time, ${plan.loop.label} over ${plan.link.name}: ${measured.measure.name} " +
      s"${value.fixed(2)} ${measured.measure.unit}".trim
