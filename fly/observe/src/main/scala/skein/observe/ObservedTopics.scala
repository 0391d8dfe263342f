package skein.observe

import skein.measure.Distribution
import skein.units.Span

/** What messages of a topic are: readings of vehicles, or commands to them. */
enum TopicKind(val label: String):
  case Readings extends TopicKind("readings")
  case Commands extends TopicKind("commands")

/** Observations of a loop whose messages are topics'. Ages are in milliseconds, when a command was sent.
  *
  * @param lasted from the first message to the last
  * @param caused commands with the stamp of the reading that caused them
  * @param byOtherClock vehicles whose stamps are by another clock than the times at which messages arrived
  * @param notKept messages of vehicles or topics beyond the most
  * @param log of the first [[LoopAccount.MostLogged]] commands
  * @param simulated where times are those of a simulation
  */
final case class ObservedTopics(
    lasted: Span,
    vehicles: Vector[ObservedVehicle],
    topics: Vector[ObservedTopic],
    caused: Long,
    byOtherClock: Vector[String],
    notKept: Long,
    log: Vector[ObservedCommand],
    simulated: Option[SimulatedTime]
):
  def commands: Long = vehicles.map(_.commands).sum

/** The simulated time of a graph.
  *
  * @param step usual time from one of its messages to the next, to within which it is known
  * @param before messages from before it began, which are not counted otherwise
  */
final case class SimulatedTime(step: Span, before: Long)

/** The messages of one topic.
  *
  * @param intervalMs from one message to the next
  * @param lateMs from a header's stamp to the arrival of its message; absent where they are on different
  *   clocks
  * @param gaps intervals of more than two and a half usual ones
  * @param backwards messages with an earlier stamp than one before
  */
final case class ObservedTopic(
    name: String,
    kind: TopicKind,
    messages: Long,
    intervalMs: Option[Distribution],
    lateMs: Option[Distribution],
    gaps: Long,
    backwards: Long
)
