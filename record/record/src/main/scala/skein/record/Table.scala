package skein.record

import java.sql.{Connection, SQLException}
import org.duckdb.DuckDBConnection
import scala.deriving.Mirror
import scala.reflect.ClassTag
import scala.util.Using
import skein.policy.Action
import skein.record.Columns.*

/** A table of a recording: the type of its rows, its name and its columns.
  *
  * @param rows class of the rows
  * @param since the first format with this table; files of older ones read as if it had no rows
  */
private[record] final case class Table[A <: Record](
    name: String,
    columns: Columns[A],
    rows: Class[?],
    since: Int = RecordingFormat.oldest
):

  /** Its columns, after the row number. */
  def numbered: Vector[Column] = Column("row", "BIGINT") +: columns.definitions

  def create: String = numbered.map(_.sql).mkString(s"CREATE TABLE $name (", ", ", ")")

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

  /** All rows with their numbers, in the order in which they were recorded. A nullable column that is missing
    * in an older file is absent, unless the older file stores it in another form.
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
      Sql.rows(connection, s"SELECT row, ${cells.mkString(", ")} FROM $name ORDER BY row"): rows =>
        val cells = Cells(rows)
        val row   = cells.next(_.getLong(_))
        (row, readRow(row, cells))

  private def readRow(row: Long, cells: Cells): A =
    try columns.read(cells)
    catch case bad: SQLException => throw SQLException(s"table $name, row $row: ${bad.getMessage}", bad)

  /** Whether an older file lacks this table. */
  def isMissing(connection: Connection): Boolean = isMissing(columnsIn(connection), connection)

  private def isMissing(present: Map[String, String], connection: Connection): Boolean =
    present.isEmpty && since > RecordingFormat.of(connection)

  /** Names and types of the table's columns in a file. */
  private def columnsIn(connection: Connection): Map[String, String] =
    val query = s"SELECT column_name, data_type FROM information_schema.columns WHERE table_name = '$name'"
    Sql.rows(connection, query)(rows => rows.getString(1) -> rows.getString(2)).toMap

private[record] object Table:
  // Columns of a later format than their table.
  private given action: FieldColumns[Option[Action]] =
    name => added(optional(summon[FieldColumns[Action]](name)))
  private given course: FieldColumns[Option[PlannedPath]] =
    name => added(optional(summon[FieldColumns[PlannedPath]](name)))
  private given states: FieldColumns[Option[PlannedStates]] =
    name => added(optional(summon[FieldColumns[PlannedStates]](name)))

  val parameter: Table[ParameterRow]          = table("parameter")
  val vehicle: Table[VehicleRow]              = table("vehicle")
  val reading: Table[ReadingRow]              = table("reading")
  val decision: Table[DecisionRow]            = table("decision")
  val sighting: Table[Sighting]               = table("sighting", since = 3)
  val measurement: Table[MeasurementRow]      = table("measurement", since = 5)
  val sensing: Table[Sensing]                 = table("sensing", since = 5)
  val image: Table[CameraImage]               = table("image", since = 6)
  val cloud: Table[Cloud]                     = table("cloud", since = 6)
  val solved: Table[SolvedRow]                = table("solved", since = 6)
  val prediction: Table[Prediction]           = table("prediction")
  val command: Table[CommandRow]              = table("command")
  val acknowledgement: Table[Acknowledgement] = table("acknowledgement")
  val latency: Table[Latency]                 = table("latency")
  val truth: Table[Truth]                     = table("truth")
  val ending: Table[Ending]                   = table("ending", since = 4)

  val planned: Table[Planned] =
    given FieldColumns[Vector[Long]] = name =>
      migrated(FieldColumns.longs(name), s"string_split($name, ',')::BIGINT[]")
    table("plan", since = 3)

  val flight: Table[FlightRow] =
    given FieldColumns[Option[String]] = name =>
      added(migrated(optional(summon[FieldColumns[String]](name)), "split_part(scenario, ',', 1)"))
    table("flight")

  /** In formats up to 4, only an event's text states which decision a fallback made; in formats up to 6, only
    * the text states the event's subject and count.
    */
  val event: Table[Event] =
    val numbers = Map(
      "decision" -> "^decision ([0-9]+) by the fallback: ",
      "count"    -> "^([0-9]+) questions were left at the solver"
    )
    val about =
      "CASE WHEN kind = 'Refused' AND contains(detail, ': no image came: ') THEN 'Camera' " +
        "WHEN kind IN ('LateReply', 'Disconnected', 'Dropped') AND contains(detail, 'solver') THEN 'Solver' " +
        "WHEN kind <> 'ClockRestarted' AND regexp_matches(detail, '^reading [0-9]+: ') THEN 'Reading' END"
    given number: FieldColumns[Option[Long]] = name =>
      val inDetail = s"try_cast(regexp_extract(detail, '${numbers(name)}', 1) AS BIGINT)"
      added(migrated(optional(FieldColumns.long(name)), inDetail))
    given subject: FieldColumns[Option[EventSubject]] = name =>
      added(migrated(optional(summon[FieldColumns[EventSubject]](name)), about))
    table("event")

  private inline def table[A <: Record: ClassTag](name: String, since: Int = RecordingFormat.oldest)(using
      Mirror.ProductOf[A]
  ): Table[A] = Table(name, columns[A](), summon[ClassTag[A]].runtimeClass, since)

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
      image,
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

  /** The tables of which [[Recording]]s are made: images and clouds are read only on request. */
  val ofRecording: Vector[Table[? <: Record]] = all.filterNot(table => table == image || table == cloud)

  private val byRows: Map[Class[?], Table[? <: Record]] = all.map(table => table.rows -> table).toMap

  def columnsOf(record: Record): Columns[Record] =
    // The table that `of` gives is that of the record's own type.
    of(record).columns.asInstanceOf[Columns[Record]]

  def of(record: Record): Table[? <: Record] = byRows(record.getClass)
