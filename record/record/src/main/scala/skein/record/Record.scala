package skein.record

import skein.policy.{Action, Agent}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vehicle.VehicleKind

/** One row of a recording; each case class below is one table. Column names are the field names followed by
  * the unit: `Ns` (an instant, nanoseconds, BIGINT), `Ms` (a length of time, milliseconds, DOUBLE), `M`,
  * `Mps`, `Rad`, `RadPerS`. `validAt`, `actsAt` and `predictedFor` are on the simulator's clock, all other
  * instants on the controller's.
  *
  * Every table begins with the column `row`, which the recorder assigns: the index of the record in the order
  * of acceptance.
  */
sealed trait Record extends Recordable:
  def row: Record = this

/** What a recorder takes: a row, or what one is made from by whoever first asks for it. That is the
  * recorder's writer, behind its queue, so that no command waits until its decision is spread over columns.
  */
sealed trait Recordable:
  def row: Record

/** A row that is made later. */
final class LaterRow(make: => Record) extends Recordable:
  lazy val row: Record = make

/** A decision whose row is made later, with what watches over the flight at once.
  *
  * @param seesOthers whether it was made from more than its own and its opponent's reading
  */
final class LaterDecision(
    val vehicle: String,
    val decidedAt: Instant,
    val action: Option[Action],
    val seesOthers: Boolean,
    make: => DecisionRow
) extends Recordable:
  lazy val row: DecisionRow = make

object Record:
  /** The bytes of an image or a cloud, if the record is one. */
  def blobOf(record: Record): Option[Blob] = record match
    case image: CameraImage => Some(image.pixels)
    case cloud: Cloud       => Some(cloud.xyz)
    case _                  => None

/** What was flown: exactly one row a recording.
  *
  * @param loop the label of a [[LoopKind]], or the name of a user's own loop
  * @param id names the flight in tables and pictures, for example `stream-vpn`
  * @param clock the label of a [[ClockKind]]
  * @param scenario its title, and whose policy was flown in place of its own: for people
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

  /** The loop's kind; None for a user's own loop. */
  def loopKind: Option[LoopKind] = LoopKind.parse(loop).toOption

  /** Whether it is the ground truth for other flights: the simulator was paused while the loop decided. */
  def isPaused: Boolean = loopKind.contains(LoopKind.Paused)

  /** Whether its world is that of the recording's parameters. */
  def isBuiltIn: Boolean = simulator == Simulator.BuiltIn

  /** The name of the scenario. */
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

  /** The parameter that states a vehicle's kind, if it is not a multirotor. */
  def kind(name: String, kind: VehicleKind): Option[ParameterRow] =
    Option.when(kind != VehicleKind.Multirotor)(ParameterRow(s"kind.$name", kind.toString))

/** One answer of the simulator.
  *
  * @param sequence counts the readings of this vehicle in the order of the requests
  */
final case class ReadingRow(sequence: Long, vehicle: String, state: Stamped[Kinematics]) extends Record

/** One answer of a sensor.
  *
  * @param sequence counts the answers of this sensor in the order of the requests
  * @param quantities names of the numbers, with units
  * @param numbers one for each quantity
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
  * @param kind kind of image, by AirSim's name, for example `Scene`
  * @param encoding `bgr8`: blue, green, red of each pixel; `32FC1`: a number a pixel, 32 bits, little-endian,
  *   m
  * @param fov horizontal; absent if unknown
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
  * @param sequence counts the received scans of this lidar
  * @param positionNed of the lidar, world
  * @param orientation from the lidar's frame (front, right, down) to the world's
  * @param validAt when it was scanned
  * @param xyz of each point in the lidar's frame, m: three numbers of 32 bits, little-endian
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
  * @param vehicle of the decision and the measurement
  * @param decision the decision's sequence
  * @param measurement the measurement's sequence
  */
final case class Sensing(vehicle: String, decision: Long, sensor: String, measurement: Long) extends Record

/** One decision for one vehicle, with all its inputs.
  *
  * @param sequence counts the decisions for this vehicle
  * @param own the vehicle's own reading that was used; its columns begin with `own`
  * @param opponent the opponent's reading that was used; its columns begin with `opponent`
  * @param relativeX the evader seen from the pursuer, along the pursuer's commanded heading; for vehicles of
  *   other roles, the opponent seen from the vehicle
  * @param relativeY likewise, to the right of that heading
  * @param headingBefore commanded last to this vehicle
  * @param opponentHeading commanded last to the opponent, as far as known
  * @param heading the one chosen
  * @param elapsed since this vehicle's last decision; zero at the first
  * @param trueAge absent until the clocks' offset is known
  * @param predicted the predicted states of both vehicles, if the decision was made from them instead of the
  *   readings
  * @param speed the one chosen; absent where the vehicle always commands its own
  * @param action the action decided; absent where heading and speed determine it, at the altitude of the
  *   start
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

/** Inputs of a decision besides its own and its opponent's reading: one row for each other vehicle, if the
  * policy uses the whole team.
  *
  * @param decider the vehicle of the decision
  * @param decision the decision's sequence
  * @param reading the sequence of the used reading of `vehicle`
  * @param predicted its predicted state, if the decision used that instead of the reading
  */
final case class Sighting(
    decider: String,
    decision: Long,
    vehicle: String,
    reading: Long,
    predicted: Option[PredictedMotion]
) extends Record

/** The planning of a decision.
  *
  * @param decision the sequence of the decision of `vehicle`
  * @param candidates simulated by all searches together
  * @param slices that each of the searches finished before the deadline; all 0 if nothing was ready: then the
  *   last plan continued, or the policy decided
  * @param cost of the chosen plan; absent if none was tried
  * @param took from the request to the decision
  * @param breaches of hard limits within the plan's horizon
  * @param course the plan's positions; absent if the policy decided instead
  * @param states initial states of the plan, if readings do not determine them completely
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

/** A decision made in another process, with the times of its request and answer.
  *
  * @param decision the sequence of the decision of `vehicle`; the decision states when it was made, by the
  *   known offset of the solver's clock
  * @param question counts the requests for `vehicle`; missing ones were not answered in time
  * @param askedAt when the request was sent
  * @param receivedAt when the answer was received
  * @param thinking from the arrival of the request at the solver to sending the answer, by the solver's clock
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

  /** Time from sending the request to receiving the answer. */
  def roundTrip: Span = receivedAt.since(askedAt)

/** The solver's clock against the controller's, as known at the request for a decision.
  *
  * @param offset the controller's clock minus the solver's
  * @param uncertainty the truth lies within ± this
  */
final case class SolverClock(offset: Span, uncertainty: Span)

/** The course of a plan: positions at the end of each step, world frame, m. The first step begins when the
  * command acts.
  */
final case class PlannedPath(north: Vector[Double], east: Vector[Double], step: Span)

/** The predicted states of the plants of a vehicle and of its opponent, as numbers; empty if its kinematics
  * determine them completely.
  */
final case class PlannedStates(own: Vector[Double], opponent: Vector[Double])

/** A vehicle's predicted motion when the command acts. */
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

/** Ages of the used readings, since physics was sampled.
  *
  * @param clockOffset the controller's clock minus the simulator's, as estimated then
  * @param uncertainty of the offset, and so of both ages: the truth lies within ± this
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

/** A prediction that later readings verified.
  *
  * @param decider the vehicle for whose decision it was made
  * @param vehicle whose position was predicted
  * @param predictedFor on the simulator's clock
  * @param age from the reading used to the time predicted for
  * @param positionNed as predicted
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

  /** A newer command replaced it. */
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

/** A vehicle's true position, if a loop samples it separately from its readings. Distances are computed from
  * these rows if there are any, else from the readings.
  */
final case class Truth(vehicle: String, validAt: Instant, positionNed: Vector3) extends Record

/** How the flight ended: the last row; missing in a truncated recording.
  *
  * @param reason why it ended early
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
  /** A newer value replaced an unused one. */
  case Dropped

  /** A period passed without its action because an earlier one had not ended. */
  case Skipped

  case TimedOut

  case DeadlineMissed

  /** A solver in another process was restarted or replaced: policies' memories start again. */
  case SolverRestarted

  /** An answer was received more than once; it counts once. */
  case Repeated

  /** A plan could not keep a hard limit. */
  case LimitBroken

  /** An answer was received after its call had ended. */
  case LateReply

  /** A bound on calls in flight refused a call. */
  case Overloaded

  case Refused

  case Disconnected

  case Reconnected

  /** The simulator was silent for longer than its answers take. */
  case SimulatorSilent

  case SimulatorBack

  /** A step of the paused simulator differed from the requested length. */
  case StepDrift

  /** The simulator's clock did not keep pace with the controller's for some seconds. */
  case ClockDrift

  /** Readings contradicted the estimated clock offset, so its estimation was restarted. */
  case ClockRestarted

  /** The simulator's clock ran backwards, stopped, jumped or differed between vehicles: the flight has no
    * result.
    */
  case ClockBroken

  /** Another client took control of a vehicle or moved it: the flight has no result. */
  case VehicleTaken

  /** The machine was too busy: the flight is not compared with others. */
  case Starved

  case Contact

  /** A call was cancelled because the flight had ended. */
  case Cancelled

  /** A policy that learns in flight has a new version, or its learner reports something. */
  case Learned

  /** A user paused the flight: its vehicles hover and no decisions are made, while its time continues. */
  case Paused

  /** A user continued a paused flight. */
  case Continued

  case Aborted
