package skein.record

import skein.units.*

/** A topic that a flight is shown by, and what its messages look like, as JSON Schema. */
final case class Topic(name: String, schemaName: String, schema: String)

/** A message of a topic. Its JSON is made when somebody first asks for it.
  *
  * @param key
  *   what it replaces the older messages of in its topic: those about the same vehicle
  * @param known
  *   when the controller knew, on its own clock
  * @param published
  *   the same, but for a prediction when it was made, and for a round trip when it began
  */
final class FlightMessage(
    val topic: String,
    val key: String,
    val known: Instant,
    val published: Instant,
    make: => String
):
  lazy val json: String = make

/** The rows of a flight as messages: every row on the topic `/skein/TABLE`, by the names of its columns, and beside them
  * views of the same rows by Foxglove's schemas ([[FoxgloveViews]]). Rows are to come in their order.
  *
  * @param from
  *   the time of rows that say none and come before all others
  * @param offset
  *   from the simulator's clock to the controller's until a decision estimates it; without one, as if the first reading
  *   had taken no time
  */
final class FlightTopics(vehicles: Vector[String], from: Instant, offset: Option[Span] = None):
  import FlightTopics.*

  private val views = FoxgloveViews(vehicles, offset)
  private var known = from

  /** What is there before the first row. */
  def opening: Vector[FlightMessage] = views.opening(from).map(message(_, "", from, from))

  /** @param number
    *   the row's place in the recording
    */
  def of(number: Long, record: Record): Vector[FlightMessage] =
    known = knownAt(record).getOrElse(known)
    val (at, published) = (known, publishedAt(record).getOrElse(known))
    val key             = keyOf(number, record)
    FlightMessage(ofTable(Table.of(record)), key, at, published, JsonRow.of(number, record)) +:
      views.of(record).map(message(_, key, at, published))

  private def message(view: FoxgloveViews.View, key: String, known: Instant, published: Instant) =
    FlightMessage(view.topic, key, known, published, view.json())

object FlightTopics:
  private[record] val Prefix = "/skein/"

  /** Of every flight, also of what has no rows in it: so a layout finds them all. */
  def all(vehicles: Vector[String]): Vector[Topic] =
    Table.all.map(table => Topic(ofTable(table), s"skein.${table.name}", JsonRow.schema(table))) ++
      FoxgloveViews.topics(vehicles).map((name, schema) => Topic(name, schema, FoxgloveSchemas.all(schema)))

  /** When it was known to the controller, if it says so. */
  def knownAt(record: Record): Option[Instant] = record match
    case reading: Reading        => Some(reading.state.receivedAt)
    case measured: Measurement   => Some(measured.receivedAt)
    case decision: Decision      => Some(decision.decidedAt)
    case solved: Solved          => Some(solved.receivedAt)
    case command: Command        => Some(command.sentAt)
    case answer: Acknowledgement => Some(answer.endedAt)
    case latency: Latency        => Some(latency.sentAt + latency.roundTrip)
    case event: Event            => Some(event.at)
    case ending: Ending          => Some(ending.at)
    case _                       => None

  private def keyOf(number: Long, record: Record): String = record match
    case reading: Reading        => reading.vehicle
    case measured: Measurement   => s"${measured.vehicle} ${measured.sensor}"
    case sensing: Sensing        => s"${sensing.vehicle} ${sensing.sensor}"
    case decision: Decision      => decision.vehicle
    case sighting: Sighting      => s"${sighting.decider} ${sighting.vehicle}"
    case planned: Planned        => planned.vehicle
    case solved: Solved          => solved.vehicle
    case prediction: Prediction  => s"${prediction.decider} ${prediction.vehicle}"
    case command: Command        => command.vehicle
    case answer: Acknowledgement => answer.vehicle
    case truth: Truth            => truth.vehicle
    case Event(_, EventKind.Paused | EventKind.Continued, _, _, _) => "paused"
    case event: Event                                              => event.vehicle.getOrElse("")
    case _: Latency | _: Ending                                    => ""
    case _: Flight | _: Parameter | _: Vehicle                     => number.toString

  private def publishedAt(record: Record): Option[Instant] = record match
    case prediction: Prediction => Some(prediction.madeAt)
    case latency: Latency       => Some(latency.sentAt)
    case _                      => None

  private def ofTable(table: Table[?]) = Prefix + table.name
