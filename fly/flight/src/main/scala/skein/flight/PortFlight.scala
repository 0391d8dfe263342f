package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.loop.*
import skein.loop.planning.PlanWorkers
import skein.port.{SteppedTime, VehiclePort}
import skein.record.*
import skein.scenario.Scenario
import skein.settings.{PredictionModel, RecordedPlan, ScenarioSettings}
import skein.units.*

/** One flight of a loop with vehicles that have a [[VehiclePort]], live or in virtual time. The vehicles must
  * be at their starts already.
  *
  * @param id the flight's name in tables and figures
  * @param loop one of Skein's loops, or a user's own graph
  * @param scenario vehicles, policies and measures
  * @param link name of the network between loop and vehicles, for the report
  * @param simulator name of the vehicles' simulator, for the report
  * @param clockKind real or virtual time; [[clock]] reads it
  * @param predictor the model that predicts all vehicles, instead of `settings.model`. The recording keeps
  *   it, so that `replay` repeats plans made with it
  * @throws IllegalArgumentException if its loop plans, and planning does not support the vehicles' models
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
    simulator: String = "own",
    predictor: Option[PredictionModel] = None
):
  private val plans = loop == LoopKind.Plan

  /** The settings of its loop: with its predictor, and plans that keep the scenario's limits. [[Replay]]
    * needs them.
    */
  val loopSettings: LoopSettings =
    val agents = scenario.fleet.agents
    settings.copy(
      model = predictor.fold(settings.model)(model => vehicle => model.forAgent(agents(vehicle))),
      planning = settings.planning.keeping(scenario)
    )
  if plans then
    val able = Planning.told(scenario.fleet).flatMap(_ => JointPlanning.of(scenario.fleet, loopSettings))
    for reason <- able.left do throw IllegalArgumentException(reason)

  def heading: RecordingHeader = RecordingHeader(
    FlightRow(
      id,
      loop.label,
      link,
      settings.seed,
      settings.period,
      duration,
      clockKind.label,
      Simulator.Other(simulator),
      scenario.title,
      FlightAssembler.version,
      clock.now(),
      Some(scenario.name)
    ),
    scenario.agents.map(VehicleRow.of),
    ScenarioSettings.recorded(scenario) ++
      (if plans then RecordedPlan.parameters(settings.planning, predictor) else Nil)
  )

  /** Starts the flight. The recorder receives every record up to the last, and is then closed.
    *
    * @param vehicles one for each agent of the scenario, in its order
    * @param time controls a simulator that can be stopped and stepped: `paused` needs it
    * @return the running flight. Its `landed` completes when the vehicles hover and everything is written
    */
  def start(vehicles: Vector[VehiclePort], recorder: Recorder, time: Option[SteppedTime] = None)(using
      system: ActorSystem
  ): PortFlight.UnderWay =
    import system.dispatcher
    val endCondition = EndCondition(scenario, loop == LoopKind.Paused, isDecentralised = false, recorder)
    val planners     = workers
    val team         = Team(scenario.fleet, vehicles, clock, endCondition, loopSettings, planners)
    val flight       = Flight.start(loop, team, time, duration, clock, endCondition)
    endCondition.isOver.foreach(_ => flight.complete())
    val landed =
      for
        outcome <- flight.outcome
        _ = planners.close()
        _ = recorder.offer(FlightAssembly.ending(outcome, clock.now()))
        written <- recorder.close()
      yield (outcome, written)
    PortFlight.UnderWay(flight, landed)

  private def workers: PlanWorkers =
    if !plans then PlanWorkers.none
    else if clockKind == ClockKind.Virtual then FlightAssembler.counted(settings.planning)
    else FlightAssembler.threads(settings.planning)

object PortFlight:
  /** A running flight.
    *
    * @param landed the flight's end, with its recording
    */
  final case class UnderWay(
      flight: Flight,
      landed: Future[(outcome: FlightOutcome, written: Either[RecordError, Written])]
  )
