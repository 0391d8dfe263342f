package skein.record

import java.sql.{Connection, SQLException}
import org.duckdb.DuckDBConnection
import scala.util.Using
import skein.record.Columns.*

/** A table of a recording: the type of its rows, its name and its columns.
  *
  * @param since
  *   the format that it came with: files of an older one do not have it, which reads as no rows
  */
private[record] final case class Table[A <: Record](
    name: String,
    columns: Columns[A],
    since: Int = RecordingFormat.oldest
):

  def create: String =
    (Column("row", "BIGINT") +: columns.definitions).map(_.sql).mkString(s"CREATE TABLE $name (", ", ", ")")

  /** Appends rows, each with its number, without committing. */
  def append(rows: Iterable[(Long, A)], connection: DuckDBConnection): Unit =
    Using.resource(connection.createAppender(name)): appender =>
      val cells = AppenderRow(appender)
      for (number, row) <- rows do
        appender.beginRow().append(number)
        columns.append(row, cells)
        appender.endRow()

  /** All rows in the order in which they were recorded. */
  def read(connection: Connection): Vector[A] = readNumbered(connection).map(_._2)

  /** The same, each with its number. A column that may be null and is missing in an older file is absent, unless the
    * older file says it in another way.
    */
  def readNumbered(connection: Connection): Vector[(Long, A)] =
    val present = columnsIn(connection)
    val cells   = columns.definitions.map: column =>
      present.get(column.name) match
        case Some(column.sqlType)    => column.name
        case None if column.nullable => column.older.getOrElse("NULL")
        case _                       => column.older.getOrElse(column.name)
    if isMissing(present, connection) then Vector.empty
    else
      Using.resource(connection.createStatement()): statement =>
        Using.resource(statement.executeQuery(
          s"SELECT row, ${cells.mkString(", ")} FROM $name ORDER BY row"
        )): rows =>
          Vector.unfold(rows): rows =>
            Option.when(rows.next()):
              val cells = Cells(rows)
              val row   = cells.next(_.getLong(_))
              ((row, readRow(row, cells)), rows)

  private def readRow(row: Long, cells: Cells): A =
    try columns.read(cells)
    catch case bad: SQLException => throw SQLException(s"table $name, row $row: ${bad.getMessage}", bad)

  /** Whether an older file does not have it. */
  def isMissing(connection: Connection): Boolean = isMissing(columnsIn(connection), connection)

  private def isMissing(present: Map[String, String], connection: Connection): Boolean =
    present.isEmpty && since > RecordingFormat.of(connection)

  /** Names and types. */
  private def columnsIn(connection: Connection): Map[String, String] =
    Using.resource(connection.createStatement()): statement =>
      Using.resource(statement.executeQuery(
        s"SELECT column_name, data_type FROM information_schema.columns WHERE table_name = '$name'"
      ))(rows =>
        Iterator.unfold(rows)(rows =>
          Option.when(rows.next())((rows.getString(1) -> rows.getString(2), rows))
        ).toMap
      )

private[record] object Table:
  private val readingColumns = product[ReadingRow]((long("sequence"), text("vehicle"), stampedKinematics))

  val flight: Table[FlightRow] = Table(
    "flight",
    product[FlightRow]:
      (
        text("id"),
        text("loop"),
        text("link"),
        long("seed"),
        spanMs("period"),
        spanMs("duration"),
        text("clock"),
        text("simulator"),
        text("scenario"),
        text("version"),
        instantNs("startedAt")
      )
  )

  val parameter: Table[Parameter] = Table("parameter", product[Parameter]((text("name"), text("value"))))

  val vehicle: Table[Vehicle] =
    Table("vehicle", product[Vehicle]((text("name"), text("role"), speed("speed"), ned("start", "M"))))

  val reading: Table[ReadingRow] = Table("reading", readingColumns)

  val decision: Table[DecisionRow] = Table(
    "decision",
    product[DecisionRow]:
      (
        long("sequence"),
        text("vehicle"),
        instantNs("decidedAt"),
        prefixed("own", readingColumns),
        prefixed("opponent", readingColumns),
        metres("relativeX"),
        metres("relativeY"),
        radians("headingBefore"),
        radians("opponentHeading"),
        radians("heading"),
        spanMs("elapsed"),
        product[Observations]:
          (
            spanMs("ownAge"),
            spanMs("opponentAge"),
            optional(spanMs("sinceOwnMove")),
            optional(spanMs("sinceOpponentMove"))
          )
        ,
        optional(
          product[TrueAge]:
            (spanMs("ownTrueAge"), spanMs("opponentTrueAge"), spanNs("clockOffset"), spanMs("uncertainty"))
        ),
        optional(
          product[Predicted]:
            (
              instantNs("actsAt"),
              ned("ownPredictedPosition", "M"),
              ned("ownPredictedVelocity", "Mps"),
              ned("opponentPredictedPosition", "M"),
              ned("opponentPredictedVelocity", "Mps")
            )
        ),
        optional(speed("speed")),
        added(optional(action))
      )
  )

  val sighting: Table[Sighting] = Table(
    "sighting",
    product[Sighting]:
      (
        text("decider"),
        long("decision"),
        text("vehicle"),
        long("reading"),
        optional(product[PredictedMotion]:
          (ned("predictedPosition", "M"), ned("predictedVelocity", "Mps")))
      )
    ,
    since = 3
  )

  val measurement: Table[Measurement] = Table(
    "measurement",
    product[Measurement]:
      (
        long("sequence"),
        text("vehicle"),
        text("sensor"),
        texts("quantities"),
        doubles("numbers"),
        instantNs("validAt"),
        instantNs("sentAt"),
        instantNs("receivedAt")
      )
    ,
    since = 5
  )

  val sensing: Table[Sensing] = Table(
    "sensing",
    product[Sensing]((text("vehicle"), long("decision"), text("sensor"), long("measurement"))),
    since = 5
  )

  val picture: Table[CameraImage] = Table(
    "image",
    product[CameraImage]:
      (
        long("sequence"),
        text("vehicle"),
        text("camera"),
        text("kind"),
        text("encoding"),
        long("width"),
        long("height"),
        optional(radians("fov")),
        ned("position", "M"),
        quaternion("orientation"),
        instantNs("validAt"),
        instantNs("sentAt"),
        instantNs("receivedAt"),
        blob("pixels")
      )
    ,
    since = 6
  )

  val cloud: Table[Cloud] = Table(
    "cloud",
    product[Cloud]:
      (
        long("sequence"),
        text("vehicle"),
        text("lidar"),
        long("points"),
        ned("position", "M"),
        quaternion("orientation"),
        instantNs("validAt"),
        instantNs("sentAt"),
        instantNs("receivedAt"),
        blob("xyz")
      )
    ,
    since = 6
  )

  val planned: Table[Planned] = Table(
    "plan",
    product[Planned]:
      (
        text("vehicle"),
        long("decision"),
        long("candidates"),
        migrated(longs("slices"), "string_split(slices, ',')::BIGINT[]"),
        optional(double("cost")),
        spanMs("took"),
        long("breaches"),
        added(optional(
          product[Course]((doubles("courseNorthM"), doubles("courseEastM"), spanMs("courseStep")))
        ))
      )
    ,
    since = 3
  )

  val solved: Table[SolvedRow] = Table(
    "solved",
    product[SolvedRow]:
      (
        text("vehicle"),
        long("decision"),
        long("question"),
        instantNs("askedAt"),
        instantNs("receivedAt"),
        spanMs("thinking"),
        optional(product[SolverClock]((spanNs("solverClockOffset"), spanMs("solverClockUncertainty"))))
      )
    ,
    since = 6
  )

  val prediction: Table[Prediction] = Table(
    "prediction",
    product[Prediction]:
      (
        text("decider"),
        text("vehicle"),
        instantNs("madeAt"),
        instantNs("predictedFor"),
        spanMs("age"),
        ned("position", "M"),
        metres("error")
      )
  )

  val command: Table[Command] = Table(
    "command",
    product[Command]:
      (
        long("sequence"),
        text("vehicle"),
        optional(long("decision")),
        speed("velocityNorth"),
        speed("velocityEast"),
        metres("down"),
        instantNs("sentAt")
      )
  )

  val acknowledgement: Table[Acknowledgement] = Table(
    "acknowledgement",
    product[Acknowledgement]((text("vehicle"), long("command"), instantNs("endedAt"), text("outcome")))
  )

  val latency: Table[Latency] =
    Table("latency", product[Latency]((text("link"), instantNs("sentAt"), spanMs("roundTrip"))))

  /** Up to format 4, only the text of the event said which decision a fallback had made. */
  private val decisionInDetail =
    "try_cast(regexp_extract(detail, '^decision ([0-9]+) by the fallback: ', 1) AS BIGINT)"

  val event: Table[Event] = Table(
    "event",
    product[Event]((
      instantNs("at"),
      eventKind("kind"),
      optional(text("vehicle")),
      text("detail"),
      added(migrated(optional(long("decision")), decisionInDetail))
    ))
  )

  val truth: Table[Truth] =
    Table("truth", product[Truth]((text("vehicle"), instantNs("validAt"), ned("position", "M"))))

  val ending: Table[Ending] =
    Table(
      "ending",
      product[Ending]((instantNs("at"), endingKind("how"), optional(text("reason")))),
      since = 4
    )

  val all: Vector[Table[? <: Record]] =
    Vector(
      flight,
      parameter,
      vehicle,
      reading,
      decision,
      sighting,
      measurement,
      sensing,
      picture,
      cloud,
      planned,
      solved,
      prediction,
      command,
      acknowledgement,
      latency,
      event,
      truth,
      ending
    )

  /** How a record lies in its table. */
  def columnsOf(record: Record): Columns[Record] =
    // The table that `of` gives is that of the record's own type.
    of(record).columns.asInstanceOf[Columns[Record]]

  /** The table that a record belongs to. */
  def of(record: Record): Table[? <: Record] = record match
    case _: FlightRow       => flight
    case _: Parameter       => parameter
    case _: Vehicle         => vehicle
    case _: ReadingRow      => reading
    case _: DecisionRow     => decision
    case _: Sighting        => sighting
    case _: Measurement     => measurement
    case _: Sensing         => sensing
    case _: CameraImage     => picture
    case _: Cloud           => cloud
    case _: Planned         => planned
    case _: SolvedRow       => solved
    case _: Prediction      => prediction
    case _: Command         => command
    case _: Acknowledgement => acknowledgement
    case _: Latency         => latency
    case _: Event           => event
    case _: Truth           => truth
    case _: Ending          => ending
