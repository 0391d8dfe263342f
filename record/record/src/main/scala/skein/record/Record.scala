package skein.record

import skein.policy.{Action, Agent, Seen}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vehicle.VehicleKind

/** One row of a recording; each case class below is one table. Column names are the field names with the unit
  * behind them: `Ns` (an instant, nanoseconds, BIGINT), `Ms` (a length of time, milliseconds, DOUBLE), `M`,
  * `Mps`, `Rad`, `RadPerS`. `validAt`, `actsAt` and `predictedFor` are on the simulator's clock, all other
  * instants on the controller's.
  *
  * Every table begins with the column `row`, which the recorder assigns: the record's index in the order in
  * which the flight's records were accepted.
  */
sealed trait Record extends Recordable:
  def row: Record = this

/** What a recorder accepts: a row, or an object that makes its row on first use. The first user is the
  * recorder's writer, behind its queue, so no command waits until its decision is spread over columns.
  */
sealed trait Recordable:
  def row: Record

/** A row of any table that is created later. See [[LaterDecision]] for decisions. */
final class LaterRow(make: => Record) extends Recordable:
  lazy val row: Record = make

/** A decision whose row is made later, with the facts that monitors of the flight need before.
  *
  * @param seesOthers whether it used other readings than its own vehicle's and its opponent's
  * @param asRead the readings that it used, not predicted, in the order of vehicles; a vehicle that was not
  *   read is missing
  */
final class LaterDecision(
    val vehicle: String,
    val decidedAt: Instant,
    val action: Action,
    val seesOthers: Boolean,
    asRead: => Vector[Seen],
    make: => DecisionRow
) extends Recordable:
  def readings: Vector[Seen] = asRead
  lazy val row: DecisionRow  = make

object Record:
  /** The large part of an image or a cloud. */
  def blobOf(record: Record): Option[Blob] = record match
    case image: CameraImage => Some(image.pixels)
    case cloud: Cloud       => Some(cloud.xyz)
    case _                  => None

/** A flight and its conditions: exactly one row per recording.
  *
  * @param loop the label of a [[LoopKind]], or the name of a user's own loop
  * @param id names the flight in tables and pictures, for example `stream-vpn`
  * @param clock the label of a [[ClockKind]]
  * @param scenario for people: the scenario's title, and the policy that replaced its own, if any
  * @param version version of the recording program
  * @param scenarioName the scenario's name for programs; without one, its title is its name
  */
final case class FlightRow(
    id: String,
    loop: String,
    link: String,
    seed: Long,
    period: Span,
    duration: Span,
    clock: String,
    simulator: Simulator,
    scenario: String,
    version: String,
    startedAt: Instant,
    scenarioName: Option[String] = None
) extends Record:

  /** The kind of one of Skein's own loops; absent for a user's loop. */
  def loopKind: Option[LoopKind] = LoopKind.parse(loop).toOption

  /** Whether it is a paused flight, a reference for other flights: the simulator stood still while a loop
    * decided.
    */
  def isPaused: Boolean = loopKind.contains(LoopKind.Paused)

  /** Whether it took place in the built-in simulator, in the world of the recording's parameters. */
  def isBuiltIn: Boolean = simulator == Simulator.BuiltIn

  def nameOfScenario: String = scenarioName.getOrElse(scenario)

  def isVirtual: Boolean = clock == ClockKind.Virtual.label

/** A run parameter that has no column in [[FlightRow]]. */
final case class ParameterRow(name: String, value: String) extends Record

/** A vehicle of the flight.
  *
  * @param role the name of a [[skein.policy.Role]], Skein's or a user's own
  * @param startNed the origin of its own frame in the world frame
  */
final case class VehicleRow(name: String, role: String, speed: MetresPerSecond, startNed: Vector3)
    extends Record

object VehicleRow:
  def of(agent: Agent): VehicleRow =
    VehicleRow(agent.name, agent.role.toString, agent.speed, agent.startPositionNed)

  /** The parameter that states a vehicle's kind; absent for multirotors. */
  def kind(name: String, kind: VehicleKind): Option[ParameterRow] =
    Option.when(kind != VehicleKind.Multirotor)(ParameterRow(s"kind.$name", kind.toString))

/** One reading of a vehicle's state.
  *
  * @param sequence counts this vehicle's readings in the order of their requests
  */
final case class ReadingRow(sequence: Long, vehicle: String, state: Stamped[Kinematics]) extends Record

/** One measurement of a sensor.
  *
  * @param sequence counts this sensor's answers in the order of their requests
  * @param quantities names of the measured values, with units
  * @param numbers the values, one for each quantity
  */
final case class MeasurementRow(
    sequence: Long,
    vehicle: String,
    sensor: String,
    quantities: Vector[String],
    numbers: Vector[Double],
    validAt: Instant,
    sentAt: Instant,
    receivedAt: Instant
) extends Record

/** An image of a vehicle's camera.
  *
  * @param sequence counts the received images of this camera
  * @param kind what it shows, by AirSim's name, for example `Scene`
  * @param encoding `bgr8`: blue, green, red of each pixel; `32FC1`: a 32-bit float for each pixel,
  *   little-endian, m
  * @param fov horizontal field of view; absent if unknown
  * @param positionNed the camera's position at exposure, world
  * @param orientation rotation from the camera's frame (front, right, down) to the world's
  * @param validAt time of exposure
  * @param pixels rows from top to bottom, without gaps
  */
final case class CameraImage(
    sequence: Long,
    vehicle: String,
    camera: String,
    kind: String,
    encoding: String,
    width: Long,
    height: Long,
    fov: Option[Radians],
    positionNed: Vector3,
    orientation: Quaternion,
    validAt: Instant,
    sentAt: Instant,
    receivedAt: Instant,
    pixels: Blob
) extends Record

/** A scan of a vehicle's lidar.
  *
  * @param sequence counts the received scans of this lidar
  * @param positionNed the lidar's position, world
  * @param orientation rotation from the lidar's frame (front, right, down) to the world's
  * @param validAt time of the scan
  * @param xyz three 32-bit floats for each point, little-endian, in the lidar's frame, m
  */
final case class Cloud(
    sequence: Long,
    vehicle: String,
    lidar: String,
    points: Long,
    positionNed: Vector3,
    orientation: Quaternion,
    validAt: Instant,
    sentAt: Instant,
    receivedAt: Instant,
    xyz: Blob
) extends Record

/** A measurement that a decision used.
  *
  * @param vehicle the vehicle that measured, and whose decision it was
  * @param decision the decision's sequence
  * @param measurement the measurement's sequence
  */
final case class Sensing(vehicle: String, decision: Long, sensor: String, measurement: Long) extends Record

/** One decision for one vehicle, with all its inputs.
  *
  * @param sequence index of the decision among this vehicle's decisions
  * @param own the vehicle's own reading that was used; its columns begin with `own`
  * @param opponent the opponent's reading that was used; its columns begin with `opponent`
  * @param relativeX the evader seen from the pursuer, along the pursuer's commanded heading; for vehicles of
  *   other roles, the opponent seen from the vehicle
  * @param relativeY likewise, to the right of that heading
  * @param headingBefore heading of the last command to this vehicle
  * @param opponentHeading heading of the last command to the opponent, as far as known
  * @param heading the chosen heading
  * @param elapsed time since this vehicle's previous decision; zero at the first
  * @param trueAge absent until the clocks' offset is known
  * @param predicted the predicted states of both vehicles, if the decision used them instead of the readings
  * @param speed the chosen speed; absent if the vehicle always commands its own speed
  * @param action the chosen action; absent if heading and speed express it, at the altitude of the start
  */
final case class DecisionRow(
    sequence: Long,
    vehicle: String,
    decidedAt: Instant,
    own: ReadingRow,
    opponent: ReadingRow,
    relativeX: Metres,
    relativeY: Metres,
    headingBefore: Radians,
    opponentHeading: Radians,
    heading: Radians,
    elapsed: Span,
    observations: Observations,
    trueAge: Option[TrueAge],
    predicted: Option[Predicted] = None,
    speed: Option[MetresPerSecond] = None,
    action: Option[Action] = None
) extends Record

/** A further reading that a decision used, besides its own vehicle's and its opponent's: one row for each
  * other vehicle, if the policy considers the whole team.
  *
  * @param decider the vehicle whose decision it was
  * @param decision the decision's sequence
  * @param reading the sequence of the reading of `vehicle` that was used
  * @param predicted its predicted motion, if the decision used that instead of the reading
  */
final case class Sighting(
    decider: String,
    decision: Long,
    vehicle: String,
    reading: Long,
    predicted: Option[PredictedMotion]
) extends Record

/** How a decision was planned.
  *
  * @param decision the sequence of the decision of `vehicle`
  * @param candidates number of candidates that all searches simulated together
  * @param slices number of slices each search finished before the deadline; all 0 if nothing was ready: then
  *   the last plan continued, or the policy decided
  * @param cost cost of the chosen plan; absent if none was simulated
  * @param took time from the request to the decision
  * @param breaches number of violations of hard limits within the plan's horizon
  * @param course the planned path; absent if the policy decided instead
  * @param states initial states of the plan, if readings do not determine them
  */
final case class Planned(
    vehicle: String,
    decision: Long,
    candidates: Long,
    slices: Vector[Long],
    cost: Option[Double],
    took: Span,
    breaches: Long,
    course: Option[PlannedPath] = None,
    states: Option[PlannedStates] = None
) extends Record

/** A decision that was made in another process, with the times of its question and answer.
  *
  * @param decision the sequence of the decision of `vehicle`; the decision says when it was made, by what was
  *   known of the solver's clock
  * @param question sequence number of the request for `vehicle`; missing numbers were not answered in time
  * @param askedAt when the question left
  * @param receivedAt when the answer arrived
  * @param thinking time from the question's arrival at the solver to the answer's departure, on the solver's
  *   clock
  * @param clock absent before the first answer of a solver
  */
final case class SolvedRow(
    vehicle: String,
    decision: Long,
    question: Long,
    askedAt: Instant,
    receivedAt: Instant,
    thinking: Span,
    clock: Option[SolverClock]
) extends Record:

  /** Time from the question's departure to the answer's arrival. */
  def roundTrip: Span = receivedAt.since(askedAt)

/** The estimated offset of the solver's clock when a decision was requested.
  *
  * @param offset the controller's clock minus the solver's
  * @param uncertainty the true offset lies within ± this
  */
final case class SolverClock(offset: Span, uncertainty: Span)

/** The path of a plan: positions at the end of each step, world frame, m. The first step begins when the
  * command acts.
  */
final case class PlannedPath(north: Vector[Double], east: Vector[Double], step: Span)

/** The predicted states of the plants of a vehicle and its opponent, by component; empty if kinematics
  * determine the state.
  */
final case class PlannedStates(own: Vector[Double], opponent: Vector[Double])

/** A vehicle's predicted motion at the time at which the command acts. */
final case class PredictedMotion(positionNed: Vector3, velocityNed: Vector3)

/** The paper's four observations at one decision. Both ages count from the *arrival* of the reading used, as
  * published; a time since a move is absent before the first move.
  */
final case class Observations(
    ownAge: Span,
    opponentAge: Span,
    sinceOwnMove: Option[Span],
    sinceOpponentMove: Option[Span]
)

/** The ages of the readings used, from the sampling of physics.
  *
  * @param clockOffset the controller's clock minus the simulator's, as estimated then
  * @param uncertainty the true offset, and so both true ages, lie within ± this
  */
final case class TrueAge(own: Span, opponent: Span, clockOffset: Span, uncertainty: Span)

/** The predicted states that a decision used instead of the readings.
  *
  * @param actsAt when the command was expected to act, on the simulator's clock
  */
final case class Predicted(
    actsAt: Instant,
    ownPositionNed: Vector3,
    ownVelocityNed: Vector3,
    opponentPositionNed: Vector3,
    opponentVelocityNed: Vector3
)

/** A prediction whose time has come, compared with readings.
  *
  * @param decider the vehicle for whose decision it was made
  * @param vehicle the vehicle whose position was predicted
  * @param predictedFor the predicted time, on the simulator's clock
  * @param age time from the extrapolated reading to the predicted time
  * @param positionNed the predicted position
  * @param error distance to the vehicle's position at that time, interpolated between two readings
  */
final case class Prediction(
    decider: String,
    vehicle: String,
    madeAt: Instant,
    predictedFor: Instant,
    age: Span,
    positionNed: Vector3,
    error: Metres
) extends Record

/** One velocity command as sent. Its outcome is an [[Acknowledgement]] of its own, so that a command is on
  * disk while its answer is outstanding.
  *
  * @param sequence counts the commands to this vehicle
  * @param decision the sequence of the decision that it carries out; absent for take-off, hover and the like
  * @param velocityNorth world frame
  * @param velocityEast world frame
  * @param down the altitude goal, NED
  */
final case class CommandRow(
    sequence: Long,
    vehicle: String,
    decision: Option[Long],
    velocityNorth: MetresPerSecond,
    velocityEast: MetresPerSecond,
    down: Metres,
    sentAt: Instant
) extends Record

/** How a command ended.
  *
  * @param command the command's sequence
  * @param endedAt when the answer arrived, or when the command was given up
  */
final case class Acknowledgement(vehicle: String, command: Long, endedAt: Instant, outcome: CommandOutcome)
    extends Record

/** How a command ended; recorded under its name, the error in a column of its own. */
enum CommandOutcome:
  case Done

  /** A newer command replaced it, as is usual in a loop that decides once a period. */
  case Superseded

  case Failed(error: String)

/** One round trip over a link. */
final case class Latency(link: String, sentAt: Instant, roundTrip: Span) extends Record

/** Something out of the ordinary: every drop, skip, timeout, reconnect, pause.
  *
  * @param vehicle absent if it concerns all
  * @param decision if a deadline was missed, the sequence of the decision that the fallback made instead, if
  *   it made one; if a policy learned, or a solver restarted, the sequence of the first decision after it
  * @param about the event's subject, if programs count such events
  * @param count number of its subjects, if not one
  */
final case class Event(
    at: Instant,
    kind: EventKind,
    vehicle: Option[String],
    detail: String,
    decision: Option[Long] = None,
    about: Option[EventSubject] = None,
    count: Option[Long] = None
) extends Record

/** A vehicle's position, in a loop that samples positions apart from its readings. Distances are computed
  * from these rows if there are any, else from the readings.
  */
final case class Truth(vehicle: String, validAt: Instant, positionNed: Vector3) extends Record

/** The end of the flight: the last row. Absent if the recording broke off before.
  *
  * @param reason why it ended early
  */
final case class Ending(at: Instant, how: EndingKind, reason: Option[String]) extends Record

/** Recorded under its name. */
enum EndingKind:
  /** It lasted for its whole duration. */
  case Completed

  /** It was stopped from outside. */
  case Stopped

  /** It could not continue. */
  case Failed

/** What an [[Event]] is about; recorded under its name. */
enum EventSubject:
  /** A request for a vehicle's reading that was not answered. */
  case Reading

  /** A camera from which requested images did not arrive. */
  case Camera

  /** The solver in another process, its link, and questions to it. */
  case Solver

/** The kind of an [[Event]]; recorded under its name. */
enum EventKind:
  /** A newer value replaced one that was not used yet. */
  case Dropped

  /** A period passed without its action because an earlier one had not ended. */
  case Skipped

  /** A call was not answered in time. */
  case TimedOut

  /** Messages between vehicles did not arrive; `count` says how many in the whole flight. */
  case MessagesLost

  /** A policy did not decide in time. */
  case DeadlineMissed

  /** A solver in another process was restarted or replaced: policies' memories start again. */
  case SolverRestarted

  /** An answer arrived more than once; it counts once. */
  case Repeated

  /** A plan could not keep within a hard limit. */
  case LimitBroken

  /** An answer arrived after its call had been given up. */
  case LateReply

  /** The bounds on calls in flight refused a call. */
  case Overloaded

  /** The simulator answered with an error. */
  case Refused

  /** A connection was lost. */
  case Disconnected

  /** A lost connection was restored. */
  case Reconnected

  /** No answer of the simulator arrived for longer than its answers take. */
  case SimulatorSilent

  /** The silent simulator answered again. */
  case SimulatorBack

  /** A step of the paused simulator was not as long as requested. */
  case StepDrift

  /** The simulator's clock did not keep pace with the controller's for some seconds. */
  case ClockDrift

  /** Readings contradicted the estimated clock offset, so its estimation was restarted. */
  case ClockRestarted

  /** The simulator's clock ran back, stood still, jumped or differed from vehicle to vehicle: the flight has
    * no result.
    */
  case ClockBroken

  /** Another client took control of a vehicle or moved it: the flight has no result. */
  case VehicleTaken

  /** The machine was too busy to fly: the flight is not compared with other flights. */
  case Starved

  /** A vehicle touched something. */
  case Contact

  /** A call was given up because the flight had ended. */
  case Cancelled

  /** A policy that learns in flight has a new version, or its learner reports something else. */
  case Learned

  /** The flight was paused from outside: its vehicles hover and no decisions are made, while its time runs
    * on.
    */
  case Paused

  /** A paused flight was continued from outside. */
  case Continued

  /** The flight ended before its time. */
  case Aborted
