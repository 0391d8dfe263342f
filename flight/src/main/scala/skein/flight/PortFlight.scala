package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.loop.*
import skein.port.{SteppedTime, VehiclePort}
import skein.record.*
import skein.scenario.Scenario
import skein.settings.ScenarioSettings
import skein.units.*

/** One flight of a loop with vehicles of any kind that have a [[VehiclePort]], live or in virtual time. The
  * vehicles must be at their starts already.
  *
  * @param id its name in tables and figures
  * @param loop one of ours, or a user's own graph
  * @param scenario who flies, by which policies, and what is measured
  * @param link name of the network between loop and vehicles, for the report
  * @param simulator name of the vehicles' simulator, for the report
  * @param clockKind real or virtual time; [[clock]] reads it
  */
final case class PortFlight(
    id: String,
    loop: AnyLoop,
    scenario: Scenario,
    duration: Span,
    clockKind: ClockKind,
    clock: Clock,
    settings: LoopSettings = LoopSettings(),
    link: String = "none",
    simulator: String = "own"
):
  /** What its recording begins with. */
  def heading: RecordingHeader = RecordingHeader(
    FlightRow(
      id,
      loop.label,
      link,
      settings.seed,
      settings.period,
      duration,
      clockKind.label,
      simulator,
      scenario.title,
      FlightAssembler.version,
      clock.now()
    ),
    scenario.agents.map(VehicleRow.of),
    ScenarioSettings.recorded(scenario)
  )

  /** Starts it. The recorder gets everything down to the last row, and is closed.
    *
    * @param vehicles one for each agent of the scenario, in its order
    * @param time of a simulator that can be stopped and stepped: `paused` needs it
    * @return the flight under way. Its `landed` completes when the vehicles hover and everything is written
    */
  def start(vehicles: Vector[VehiclePort], recorder: Recorder, time: Option[SteppedTime] = None)(using
      system: ActorSystem
  ): PortFlight.UnderWay =
    import system.dispatcher
    val endCondition = EndCondition(scenario, loop == LoopKind.Paused, recorder)
    val team         = Team(scenario.fleet, vehicles, clock, endCondition, settings)
    val flight       = Flight.start(loop, team, time, duration, clock, endCondition)
    endCondition.isOver.foreach(_ => flight.complete())
    val landed =
      for
        outcome <- flight.outcome
        _ = recorder.offer(FlightAssembly.ending(outcome, clock.now()))
        written <- recorder.close()
      yield (outcome, written)
    PortFlight.UnderWay(flight, landed)

object PortFlight:
  /** @param landed how it ended, and what is on record
    */
  final case class UnderWay(
      flight: Flight,
      landed: Future[(outcome: FlightOutcome, written: Either[RecordError, Written])]
  )
