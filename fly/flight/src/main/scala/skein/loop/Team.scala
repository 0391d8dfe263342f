package skein.loop

import scala.concurrent.ExecutionContext
import skein.flow.Hold
import skein.loop.planning.PlanWorkers
import skein.policy.Fleet
import skein.port.VehiclePort
import skein.record.Recorder
import skein.signal.ClockAlignment
import skein.units.*

/** A scenario with its vehicles: the operators from which every loop is built, with recording.
  *
  * @param solver decides instead of the policies; the settings then have a deadline
  * @param clocks the vehicles' clock against the controller's, as far as known before the first reading
  * @param only the one vehicle that this controller commands, while it reads all; None commands all vehicles
  * @param hold while it is held, the vehicles hover without decisions; they are still read
  * @param messages messages from which one vehicle's controller knows the other vehicles, instead of reading
  *   them
  */
final class Team(
    val fleet: Fleet,
    ports: Vector[VehiclePort],
    clock: Clock,
    recorder: Recorder,
    val settings: LoopSettings,
    workers: PlanWorkers = PlanWorkers.none,
    solver: Option[Solver] = None,
    clocks: Option[ClockAlignment] = None,
    only: Option[Int] = None,
    val hold: Hold = Hold(),
    messages: Option[Messages] = None
)(using ExecutionContext):
  require(ports.size == fleet.agents.size, "one vehicle per agent")
  require(messages.isEmpty || only.isDefined, "messages are for the controller of one vehicle")
  require(solver.isEmpty || settings.deadline.isDefined, "who is asked elsewhere needs a deadline")

  val vehicles: Range = ports.indices

  /** The vehicles for which it decides, and which it commands. */
  val own: Vector[Int] = only.fold(vehicles.toVector)(Vector(_))
  for missing <- Team.missingSensor(fleet, ports, own) do throw IllegalArgumentException(missing)

  private val deciders = vehicles.map(Decider(fleet, _))
  val log: TeamLog     = TeamLog(fleet, deciders, clock, recorder)

  private val parts    = TeamParts(fleet, own, clock, settings, log)
  private val sensing  = TeamSensing(ports, clocks, messages, parts)
  private val viewing  = TeamViewing(clocks, messages.isDefined, hold, sensing, parts)
  private val deciding = TeamDeciding(deciders, workers, solver, sensing, parts)
  private val steering = TeamSteering(ports, hold, sensing, parts)

  export parts.{meters, named}
  export sensing.{isNewer, joinLatest, read, readAll, sense, senseAll, sensed, ticks}
  export viewing.{cast, due, events, view, viewWithForecast}
  export deciding.{decide, decideAt, decideWithin, foresee, plan, planning, predict, start, underDecision}
  export steering.{
    fan,
    feedBack,
    feedBackAll,
    hoverAll,
    move,
    newest,
    pace,
    record,
    sent,
    steer,
    steered,
    told
  }

  def now: Instant = clock.now()

object Team:

  /** A sensor that a policy requests and its vehicle lacks, as a line for the user. */
  private[skein] def missingSensor(
      fleet: Fleet,
      vehicles: Vector[VehiclePort],
      own: Vector[Int]
  ): Option[String] =
    own.flatMap(self =>
      val (agent, vehicle) = (fleet.agents(self), vehicles(self))
      agent.policy.sensors.toVector.sorted.filterNot(vehicle.sensors.contains).map: name =>
        val known = vehicle.sensors.keys.toVector.sorted
        val has   = if known.isEmpty then "it has none" else s"expected one of ${known.mkString(", ")}"
        s"the policy of ${agent.name} reads a sensor '$name' that the vehicle does not have: $has"
    ).headOption
