package skein.observe

import skein.measure.Distribution
import skein.units.Span

/** The kind of a topic's messages: readings of vehicles, or commands to them. */
enum TopicKind(val label: String):
  case Readings extends TopicKind("readings")
  case Commands extends TopicKind("commands")

/** Observations of a loop that exchanges messages on topics. Ages are in milliseconds, at the time of a
  * command.
  *
  * @param lasted time from the first message to the last
  * @param caused number of commands with the stamp of the reading that caused them
  * @param byOtherClock vehicles whose stamps are not by the clock of the arrival times
  * @param notKept number of messages of vehicles or topics beyond the limit
  * @param log the first [[LoopAccount.MostLogged]] commands
  * @param simulated present if times are simulated
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
  * @param step usual interval of its messages: the uncertainty of the time
  * @param before number of messages before it began, which are not counted elsewhere
  */
final case class SimulatedTime(step: Span, before: Long)

/** The messages of one topic.
  *
  * @param intervalMs times from one message to the next
  * @param lateMs times from a header's stamp to the arrival of its message; absent if these are on different
  *   clocks
  * @param gaps number of intervals longer than 2.5 usual ones
  * @param backwards number of messages with an earlier stamp than a previous one
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
