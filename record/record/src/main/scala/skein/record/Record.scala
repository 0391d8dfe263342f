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
  * Every table begins with the column `row`, which the recorder assigns: the place of the record in the order
  * in which all records of the flight were accepted.
  */
sealed trait Record extends Recordable:
  def row: Record = this

/** What a recorder takes: a row, or what one is made from by whoever first asks for it. That is the
  * recorder's writer, behind its queue, so that no command waits until its decision is spread over columns.
  */
sealed trait Recordable:
  def row: Record

/** A row of any table that is made later. See [[LaterDecision]] for decisions. */
final class LaterRow(make: => Record) extends Recordable:
  lazy val row: Record = make

/** A decision whose row is made later, with what those need who watch over the flight meanwhile.
  *
  * @param seesOthers whether it was made from more than its own and its opponent's reading
  * @param asRead the readings from which it was made, not predicted; by the vehicle's number where all were
  *   read
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
  lazy val row: DecisionRow = make

object Record:
  /** The large part of an image or a cloud. */
  def blobOf(record: Record): Option[Blob] = record match
    case image: CameraImage => Some(image.pixels)
    case cloud: Cloud       => Some(cloud.xyz)
    case _                  => None

/** What was flown: exactly one row a recording.
  *
  * @param loop the label of a [[LoopKind]], or the name of a user's own loop
  * @param id names the flight in tables and pictures, for example `stream-vpn`
  * @param clock the label of a [[ClockKind]]
  * @param scenario its title, and the policy in the place of its own, if there was one: for people
  * @param version of the program that recorded
  * @param scenarioName by which a program knows the scenario; without one, its title is its name
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

  /** Absent for a loop that is none of ours. */
  def loopKind: Option[LoopKind] = LoopKind.parse(loop).toOption

  /** Whether it is the truth that others are held against: the simulator stood still while a loop decided. */
  def isPaused: Boolean = loopKind.contains(LoopKind.Paused)

  /** Whether its world is that of the recording's parameters. */
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

  /** The parameter that says what a vehicle is, where it is no multirotor. */
  def kind(name: String, kind: VehicleKind): Option[ParameterRow] =
    Option.when(kind != VehicleKind.Multirotor)(ParameterRow(s"kind.$name", kind.toString))

/** One answer of the simulator.
  *
  * @param sequence counts the readings of this vehicle in the order in which they were asked for
  */
final case class ReadingRow(sequence: Long, vehicle: String, state: Stamped[Kinematics]) extends Record

/** One answer of a sensor.
  *
  * @param sequence counts the answers of this sensor, in the order of the questions
  * @param quantities names of the numbers, with units
  * @param numbers as many
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
  * @param sequence counts the images of this camera that came
  * @param kind what it shows, by AirSim's name, for example `Scene`
  * @param encoding `bgr8`: blue, green, red of each pixel; `32FC1`: a number a pixel, 32 bits, the lowest
  *   first, m
  * @param fov horizontal; absent where nobody has told
  * @param positionNed of the camera, world, when it was exposed
  * @param orientation from the camera's frame (front, right, down) to the world's
  * @param validAt when it was exposed
  * @param pixels in rows from the top, without gaps
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
  * @param sequence counts the scans of this lidar that came
  * @param positionNed of the lidar, world
  * @param orientation from the lidar's frame (front, right, down) to the world's
  * @param validAt when it was scanned
  * @param xyz of each point in the lidar's frame, m: three numbers of 32 bits, the lowest byte first
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

/** A measurement that a decision was made from.
  *
  * @param vehicle that was decided for, and that measured
  * @param decision the decision's sequence
  * @param measurement the measurement's sequence
  */
final case class Sensing(vehicle: String, decision: Long, sensor: String, measurement: Long) extends Record

/** One decision for one vehicle, with everything that it was made from.
  *
  * @param sequence counts the decisions for this vehicle
  * @param own the vehicle's own reading that was used; its columns begin with `own`
  * @param opponent the opponent's reading that was used; its columns begin with `opponent`
  * @param relativeX the evader seen from the pursuer, along the pursuer's commanded heading; for vehicles of
  *   other roles, the opponent seen from the vehicle
  * @param relativeY the same, to the right of that heading
  * @param headingBefore commanded last to this vehicle
  * @param opponentHeading commanded last to the opponent, as far as known
  * @param heading the one chosen
  * @param elapsed since this vehicle's last decision; zero at the first
  * @param trueAge absent until the clocks' offset is known
  * @param predicted the predicted states of both vehicles, if the decision was made from them instead of the
  *   readings
  * @param speed the one chosen; absent where the vehicle always commands its own
  * @param action the action decided; absent where heading and speed say it, at the altitude of the start
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

/** What a decision was made from besides its own and its opponent's reading: one row for each other vehicle,
  * where the policy regards the whole team.
  *
  * @param decider the vehicle that was decided for
  * @param decision the decision's sequence
  * @param reading the sequence of the reading of `vehicle` that was used
  * @param predicted where it was expected to be, if that was decided upon instead of the reading
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
  * @param candidates flown by all searches together
  * @param slices that each of the searches finished before the deadline; all 0 where nothing was ready: then
  *   the last plan went on, or the policy decided
  * @param cost of the plan chosen; absent where none was tried
  * @param took from asking until the decision was there
  * @param breaches of hard limits within the plan's horizon
  * @param course where the plan leads; absent where the policy decided in its place
  * @param states from which it was planned, where readings do not tell all of them
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

/** A decision that was made in another process, and the times of its ways there and back.
  *
  * @param decision the sequence of the decision of `vehicle`; the decision says when it was made, by what was
  *   known of the solver's clock
  * @param question counts the questions for `vehicle`; those that are missing here were not answered in time
  * @param askedAt when the question left
  * @param receivedAt when the answer came
  * @param thinking from the question's coming to the solver to the answer's leaving, by the solver's clock
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

  /** From the question's leaving to the answer's coming. */
  def roundTrip: Span = receivedAt.since(askedAt)

/** How the solver's clock stood to the controller's, as was known when a decision was asked for.
  *
  * @param offset the controller's clock minus the solver's
  * @param uncertainty the truth lies within ± this
  */
final case class SolverClock(offset: Span, uncertainty: Span)

/** Where a plan leads: places at the end of each step, world frame, m. The first step begins when the command
  * acts.
  */
final case class PlannedPath(north: Vector[Double], east: Vector[Double], step: Span)

/** The predicted states of the plants of a vehicle and of its opponent, as numbers; empty where its
  * kinematics tell all of one.
  */
final case class PlannedStates(own: Vector[Double], opponent: Vector[Double])

/** Where a vehicle was expected to be when the command acts. */
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

/** How old the readings used were, from when physics was sampled.
  *
  * @param clockOffset the controller's clock minus the simulator's, as estimated then
  * @param uncertainty of the offset, and so of both ages: the truth lies within ± this
  */
final case class TrueAge(own: Span, opponent: Span, clockOffset: Span, uncertainty: Span)

/** The predicted states that a decision was made from instead of the readings.
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

/** A prediction whose moment has come and was read.
  *
  * @param decider the vehicle for whose decision it was made
  * @param vehicle whose place was predicted
  * @param predictedFor on the simulator's clock
  * @param age from the reading that was carried forward to the moment predicted for
  * @param positionNed as predicted
  * @param error distance to where the vehicle was then, between two readings interpolated
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

/** One velocity command as sent. What became of it is an [[Acknowledgement]] of its own, so that a command is
  * on disk while its answer is outstanding.
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
  * @param endedAt when the answer came, or when it was given up
  */
final case class Acknowledgement(vehicle: String, command: Long, endedAt: Instant, outcome: CommandOutcome)
    extends Record

/** How a command ended; recorded by name, the error in a column of its own. */
enum CommandOutcome:
  case Done

  /** A newer command replaced it, as most are where a loop decides once a period. */
  case Superseded

  case Failed(error: String)

/** One round trip over a link. */
final case class Latency(link: String, sentAt: Instant, roundTrip: Span) extends Record

/** Something out of the ordinary: every drop, skip, timeout, reconnect, pause.
  *
  * @param vehicle absent where it concerns all
  * @param decision where a deadline was missed, the sequence of the decision that the fallback made instead;
  *   absent where it made none. Where something was learned, or a solver began anew, the sequence of the
  *   first decision after it
  * @param about what it is about, where programs count such events
  * @param count of what it is about, where it is not one
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

/** Where a vehicle was, where a loop samples that apart from its readings. Distances are computed from these
  * rows if there are any, else from the readings.
  */
final case class Truth(vehicle: String, validAt: Instant, positionNed: Vector3) extends Record

/** How the flight ended: the last row. There is none where the recording broke off before.
  *
  * @param reason why it ended before its time
  */
final case class Ending(at: Instant, how: EndingKind, reason: Option[String]) extends Record

/** Recorded by name. */
enum EndingKind:
  /** It flew its whole time. */
  case Completed

  /** It was stopped from outside. */
  case Stopped

  /** It could not go on. */
  case Failed

/** What an [[Event]] is about; recorded by name. */
enum EventSubject:
  /** A question where a vehicle is, which was not answered. */
  case Reading

  /** A camera of which images were wanted, and none came. */
  case Camera

  /** The solver in another process, its link, and questions to it. */
  case Solver

/** What an [[Event]] tells of; recorded by name. */
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

  /** A solver in another process was started again, or another one answers: what policies remember begins
    * anew.
    */
  case SolverRestarted

  /** An answer came more than once; it counts once. */
  case Repeated

  /** A plan could not keep within a hard limit. */
  case LimitBroken

  /** An answer came after its call had been given up. */
  case LateReply

  /** The bounds on calls in flight refused a call. */
  case Overloaded

  /** The simulator answered with an error. */
  case Refused

  /** A connection was lost. */
  case Disconnected

  /** A connection is there again. */
  case Reconnected

  /** Nothing was heard of the simulator for longer than its answers take. */
  case SimulatorSilent

  /** The simulator was heard of again. */
  case SimulatorBack

  /** A step of the paused simulator was not as long as asked for. */
  case StepDrift

  /** The simulator's clock did not keep pace with the controller's for some seconds. */
  case ClockDrift

  /** Readings contradicted the known offset of the clocks, so its estimation began anew. */
  case ClockRestarted

  /** The simulator's clock ran back, stood still, jumped or differed from vehicle to vehicle: the flight has
    * no result.
    */
  case ClockBroken

  /** Somebody else took a vehicle from the flight or put it elsewhere: the flight has no result. */
  case VehicleTaken

  /** The machine was too busy to fly: the flight is not compared with others. */
  case Starved

  /** A vehicle touched something. */
  case Contact

  /** A call was given up because the flight had ended. */
  case Cancelled

  /** A policy that learns in flight has a new version, or what else its learner says. */
  case Learned

  /** Somebody paused the flight: its vehicles hover and nobody decides, while its time runs on. */
  case Paused

  /** A paused flight was continued from outside. */
  case Continued

  /** The flight ended before its time. */
  case Aborted
