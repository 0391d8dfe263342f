package skein.observe

import skein.measure.Distribution
import skein.units.Span

/** Observations of a loop. Ages are in milliseconds, at the moment at which a command passed.
  *
  * @param lasted time from the first call to the last message
  * @param vehicles the vehicles that were read or commanded, in the order of their first call
  * @param methods the called methods, in the order of their first call
  * @param periodMs how a period from command to command was spent, on average; empty before the second
  *   command
  * @param clock the simulator's clock; absent if no state had a time stamp
  * @param stalls stalls during which calls waited for much longer than usual, the longest first
  * @param smallCallMs round trips of small calls, without and with a simultaneous transfer of an image
  * @param lost descriptions of connections whose bytes could not be parsed
  * @param notKept number of messages that passed while the observer had no room for them
  * @param log the first [[LoopAccount.MostLogged]] commands
  */
final case class Observed(
    lasted: Span,
    connections: Int,
    vehicles: Vector[ObservedVehicle],
    methods: Vector[ObservedMethod],
    periodMs: Map[String, Double],
    clock: Option[SimulatorClock],
    stalls: Vector[Stall],
    smallCallMs: (quiet: Option[Distribution], besideImages: Option[Distribution]),
    readsOverlap: Double,
    imagesOnCommandConnections: Long,
    pauses: Long,
    lost: Vector[String],
    notKept: Long,
    log: Vector[ObservedCommand]
):
  def commands: Long = vehicles.map(_.commands).sum

/** One command. Ages and times since are in milliseconds; absent if there was no reading or command before.
  *
  * @param at time since the first call
  * @param boundMs half width of the uncertainty of `ownAgeMs`
  * @param sinceOwnMs time since the last command to the vehicle; `sinceOthersMs`: to any other
  * @param unanswered number of calls of any kind without an answer when it passed, itself included; absent if
  *   nothing is answered
  */
final case class ObservedCommand(
    at: Span,
    vehicle: String,
    method: String,
    connection: Int,
    ownAgeMs: Option[Double],
    othersAgeMs: Option[Double],
    boundMs: Option[Double],
    sinceOwnMs: Option[Double],
    sinceOthersMs: Option[Double],
    unanswered: Option[Int] = None
)

/** Some commands to one vehicle: the maximum of each value of [[ObservedCommand]]. */
final case class NewCommands(
    vehicle: String,
    ownAgeMs: Option[Double],
    sinceOwnMs: Option[Double],
    unanswered: Option[Int]
):
  def worst(other: NewCommands): NewCommands = NewCommands(
    vehicle,
    (ownAgeMs ++ other.ownAgeMs).maxOption,
    (sinceOwnMs ++ other.sinceOwnMs).maxOption,
    (unanswered ++ other.unanswered).maxOption
  )

object NewCommands:
  def of(command: ObservedCommand): NewCommands =
    NewCommands(command.vehicle, command.ownAgeMs, command.sinceOwnMs, command.unanswered)

/** The commands to one vehicle.
  *
  * @param ownAgeMs ages of the vehicle's newest reading, since physics was sampled
  * @param othersAgeMs ages of the other vehicles' newest readings, the oldest of them; see [[LoopAccount]]
  * @param boundMs half width of the ages' uncertainty
  * @param everyMs times from one command to the next
  * @param sinceOthersMs times since any other vehicle was commanded
  * @param skewMs times between the oldest and the newest reading of all vehicles
  * @param early number of commands before a vehicle's clock was compared with ours, whose ages are left out
  * @param superseded number of commands replaced by the next before a physics step could apply them
  * @param overtaken number of commands that reached the simulator after a later one
  * @param mostInFlight largest number of simultaneously unanswered commands
  * @param joined number of commands during which their connection sent nothing else: the program waited for
  *   their ends
  * @param leftRunning number of commands unanswered when their connection closed
  */
final case class ObservedVehicle(
    name: String,
    commands: Long,
    ownAgeMs: Option[Distribution],
    othersAgeMs: Option[Distribution],
    boundMs: Option[Double],
    everyMs: Option[Distribution],
    sinceOthersMs: Option[Distribution],
    skewMs: Option[Distribution],
    early: Long,
    superseded: Long,
    overtaken: Long,
    mostInFlight: Int,
    joined: Long,
    leftRunning: Long
)

/** The calls of one method.
  *
  * @param roundTripMs absent before the first answer
  * @param firstError absent if none failed
  */
final case class ObservedMethod(
    method: String,
    kind: CallKind,
    calls: Long,
    failed: Long,
    roundTripMs: Option[Distribution],
    answerBytes: Long,
    firstError: Option[String]
)

/** The simulator's clock by its time stamps.
  *
  * @param rate its seconds in a second of the observer's clock
  * @param backwards number of times it ran back
  * @param stoodStill total time, except while it was paused by a client
  */
final case class SimulatorClock(rate: Double, backwards: Long, stoodStill: Span)

/** Calls that waited simultaneously.
  *
  * @param at time of the end, since the first call
  */
final case class Stall(at: Span, length: Span, method: String)

/** The progress of an observation.
  *
  * @param agesMs mean age of the vehicle's own data, for each vehicle that was read before a command to it
  */
final case class Progress(lasted: Span, commands: Long, agesMs: Vector[(vehicle: String, ms: Double)])
