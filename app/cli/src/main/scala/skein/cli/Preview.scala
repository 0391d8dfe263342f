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

/** The first results of live flights: their virtual twins, simulated before them while little time is lost,
  * and not a second time afterwards.
  */
private[cli] object Preview:

  /** Time after which no further flight is started. */
  val AtMost: Span = Span.ofSeconds(6)

  type Flown = Map[FlightPlan, VirtualFlightResult]

  /** Whether one flight ends within [[AtMost]] if it is as fast as those of the warm-up were on average.
    *
    * @param flights of the warm-up
    * @param took all of them together
    */
  def fits(flights: Int, took: Span, duration: Span): Boolean =
    val warmed = duration.min(WarmUp.Flown).toSeconds * flights
    flights > 0 && took.toSeconds * duration.toSeconds <= AtMost.toSeconds * warmed

  /** Whether a flight's twin can come before its live flight: not if another process decides, for which
    * virtual time stands still.
    */
  def isPossible(plan: FlightPlan): Boolean =
    plan.solver.isEmpty && !plan.policy.exists(policy => OutsidePolicy.decides(policy.file))

  /** Flies twins on all cores, in their order, and prints a line for each as it ends. Blocks.
    *
    * @param say prints a line
    * @return the completed flights; failed ones are simulated again, and reported then
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

  /** The scenario's first measure of a flight; none where its code fails, which the report explains. */
  private def line(scenario: Scenario, plan: FlightPlan, flown: VirtualFlightResult): Option[String] =
    for
      tracks   <- Tracks.of(RecordedTracks.of(flown.recorder.recording))
      measured <- Try(Result.of(scenario, tracks).measured).toOption.flatMap(_.headOption)
      value    <- measured.value
    yield s"in virtual time, ${plan.loop.label} over ${plan.link.name}: ${measured.measure.name} " +
      s"${value.fixed(2)} ${measured.measure.unit}".trim
