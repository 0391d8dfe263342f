package skein.record

import java.nio.charset.StandardCharsets.UTF_8
import skein.scene.Scene
import skein.units.*

/** A topic of a flight's messages, with their schema.
  *
  * @param schema JSON Schema; of binary messages a `FileDescriptorSet` of Protocol Buffers, in Base64
  * @param isBinary whether messages are of Protocol Buffers, else JSON
  * @param newestOnly whether a newer message makes older ones useless
  */
final case class Topic(
    name: String,
    schemaName: String,
    schema: String,
    isBinary: Boolean = false,
    newestOnly: Boolean = false
)

/** A message of a topic. Its bytes are made on first request.
  *
  * @param key older messages of the topic with this key are replaced: those about one vehicle
  * @param known when the controller knew the fact, on its own clock
  * @param published when a prediction was made or a round trip began; for any other message equal to `known`
  */
final class FlightMessage(
    val topic: String,
    val key: String,
    val known: Instant,
    val published: Instant,
    make: () => Array[Byte]
):
  lazy val bytes: Array[Byte] = make()

object FlightMessage:
  def json(topic: String, key: String, known: Instant, published: Instant)(text: => String): FlightMessage =
    FlightMessage(topic, key, known, published, () => text.getBytes(UTF_8))

/** Converts the rows of a flight to messages: every row on the topic `/skein/TABLE`, by the names of its
  * columns, and views of the rows by Foxglove's schemas ([[FoxgloveViews]]). Rows must be given in order.
  *
  * @param from time that is assigned to the first rows, which have none
  * @param offset offset from the simulator's clock to the controller's, until a decision estimates it; None:
  *   the first reading is assumed to have no latency
  * @param scene the scene of the flight's world
  * @param form encoding of images and clouds
  */
final class FlightTopics(
    vehicles: Vector[String],
    from: Instant,
    offset: Option[Span] = None,
    scene: Scene = Scene.Empty,
    form: ImageEncoding = ImageEncoding.Whole
):
  import FlightTopics.*

  private val views = FoxgloveViews(vehicles, offset, scene, form)
  private var known = from

  /** The messages that precede those of the first row. */
  def opening: Vector[FlightMessage] = views.opening(from).map(message(_, "", from, from))

  /** @param number index of the row in the recording */
  def of(number: Long, record: Record): Vector[FlightMessage] =
    known = knownAt(record).getOrElse(known)
    val (at, published) = (known, publishedAt(record).getOrElse(known))
    val key             = keyOf(number, record)
    FlightMessage.json(ofTable(Table.of(record)), key, at, published)(JsonRow.of(number, record)) +:
      views.of(record).map(message(_, key, at, published))

  private def message(view: FoxgloveViews.View, key: String, known: Instant, published: Instant) =
    FlightMessage(view.topic, key, known, published, view.make)

object FlightTopics:
  private[record] val Prefix = "/skein/"

  /** The topics of every flight, including those without rows, so that a layout finds all of them. */
  def all(vehicles: Vector[String]): Vector[Topic] =
    Table.all.map(table => Topic(ofTable(table), s"skein.${table.name}", JsonRow.schema(table))) ++
      FoxgloveViews.topics(vehicles).map((name, schema) => Topic(name, schema, FoxgloveSchemas.all(schema)))

  def of(sensor: ImagingSensor, form: ImageEncoding = ImageEncoding.Whole): Vector[Topic] =
    def binary(name: String, schema: String) =
      Topic(name, schema, FoxgloveSchemas.binary(schema), isBinary = true, newestOnly = true)
    if sensor.isLidar then Vector(binary(FoxgloveViews.cloudOf(sensor), "foxglove.PointCloud"))
    else
      val calibration = "foxglove.CameraCalibration"
      Vector(
        Topic(FoxgloveViews.calibrationOf(sensor), calibration, FoxgloveSchemas.all(calibration)),
        binary(FoxgloveViews.imageOf(sensor), form.imageSchema)
      )

  /** The time of the first row that states one; without any, the beginning of time. */
  def startOf(rows: Vector[(Long, Record)]): Instant =
    rows.iterator.flatMap((_, record) => knownAt(record)).nextOption().getOrElse(Instant.Epoch)

  /** The time at which the controller knew the record's fact; None if the record does not state it. */
  def knownAt(record: Record): Option[Instant] = record match
    case reading: ReadingRow      => Some(reading.state.receivedAt)
    case measured: MeasurementRow => Some(measured.receivedAt)
    case image: CameraImage       => Some(image.receivedAt)
    case cloud: Cloud             => Some(cloud.receivedAt)
    case decision: DecisionRow    => Some(decision.decidedAt)
    case solved: SolvedRow        => Some(solved.receivedAt)
    case command: CommandRow      => Some(command.sentAt)
    case answer: Acknowledgement  => Some(answer.endedAt)
    case latency: Latency         => Some(latency.sentAt + latency.roundTrip)
    case event: Event             => Some(event.at)
    case ending: Ending           => Some(ending.at)
    case _                        => None

  private def keyOf(number: Long, record: Record): String = record match
    case reading: ReadingRow      => reading.vehicle
    case measured: MeasurementRow => s"${measured.vehicle} ${measured.sensor}"
    case sensing: Sensing         => s"${sensing.vehicle} ${sensing.sensor}"
    case image: CameraImage       => s"${image.vehicle} ${image.camera} ${image.kind}"
    case cloud: Cloud             => s"${cloud.vehicle} ${cloud.lidar}"
    case decision: DecisionRow    => decision.vehicle
    case sighting: Sighting       => s"${sighting.decider} ${sighting.vehicle}"
    case planned: Planned         => planned.vehicle
    case solved: SolvedRow        => solved.vehicle
    case prediction: Prediction   => s"${prediction.decider} ${prediction.vehicle}"
    case command: CommandRow      => command.vehicle
    case answer: Acknowledgement  => answer.vehicle
    case truth: Truth             => truth.vehicle
    case event: Event if Set(EventKind.Paused, EventKind.Continued)(event.kind) => "paused"
    case event: Event                                                           => event.vehicle.getOrElse("")
    case _: Latency | _: Ending                                                 => ""
    case _: FlightRow | _: ParameterRow | _: VehicleRow                         => number.toString

  private def publishedAt(record: Record): Option[Instant] = record match
    case prediction: Prediction => Some(prediction.madeAt)
    case latency: Latency       => Some(latency.sentAt)
    case _                      => None

  private def ofTable(table: Table[?]) = Prefix + table.name
