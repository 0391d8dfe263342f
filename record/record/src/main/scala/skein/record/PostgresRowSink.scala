package skein.record

import java.net.URLDecoder
import java.nio.charset.StandardCharsets
import java.sql.{Connection, DriverManager, PreparedStatement, SQLException, Types}
import java.util.Properties
import java.util.concurrent.atomic.AtomicLong
import java.util.concurrent.{ArrayBlockingQueue, TimeUnit}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import scala.util.control.NonFatal

/** Writes a flight into a Postgres database in addition to its recording: equal tables and columns, in a
  * schema named after the flight. A thread of its own writes; if the database is slower than the flight, rows
  * beyond [[PostgresRowSink.Capacity]] are dropped; their number is reported at the end, and that of rows
  * that a lost connection did not take.
  */
final class PostgresRowSink private (connection: Connection, schema: String, target: PostgresAddress)
    extends RowSink:
  import PostgresRowSink.*

  private val queue            = ArrayBlockingQueue[(Long, Record)](Capacity)
  private val dropped          = AtomicLong()
  private val refused          = AtomicLong()
  private val waitingBytes     = AtomicLong()
  private val inserts          = scala.collection.mutable.Map.empty[String, PreparedStatement]
  @volatile private var ended  = false
  @volatile private var failed = Option.empty[String]

  /** Number of rows that are taken from the queue and not yet committed. */
  @volatile private var writing = 0

  private val writer = Thread.ofPlatform().daemon().name("skein-postgres").start(() => writeAll())

  def put(rows: Seq[(Long, Record)]): Unit = rows.foreach: row =>
    val size = Record.blobOf(row._2).fold(0)(_.size)
    if failed.isDefined then refused.incrementAndGet(): Unit
    else if waitingBytes.get + size > MostWaitingBytes || !queue.offer(row) then
      dropped.incrementAndGet(): Unit
    else waitingBytes.addAndGet(size): Unit

  def close(): Unit =
    ended = true
    writer.join(CloseWithin)
    if writer.isAlive then
      failed = failed.orElse(Some(s"did not take the last rows within ${CloseWithin / 1000} s"))
      writer.interrupt()

  def discard(): Unit =
    attempt(
      target,
      Using.resource(target.connect())(Sql.execute(_, s"DROP SCHEMA \"$schema\" CASCADE"))
    )
      .left
      .foreach(why => failed = failed.orElse(Some(why)))

  def failure: Option[String] =
    val unsent  = refused.get + queue.size + writing
    val reasons =
      failed.map(why => if unsent == 0 then why else s"$why; $unsent rows are missing from there on") ++
        Option.when(dropped.get > 0)(s"${dropped.get} rows are missing, since it is slower than the flight")
    Option.when(reasons.nonEmpty)(s"Postgres, schema $schema: ${reasons.mkString("; ")}")

  private def writeAll(): Unit =
    try
      Using.resource(connection): _ =>
        while !(ended && queue.isEmpty) do
          val first = queue.poll(PollMillis, TimeUnit.MILLISECONDS)
          if first != null then
            val batch = java.util.ArrayList[(Long, Record)](BatchSize)
            batch.add(first): Unit
            writing = 1 + queue.drainTo(batch, BatchSize - 1)
            write(batch.asScala.toVector)
            writing = 0
            batch.forEach(row => Record.blobOf(row._2).foreach(blob => waitingBytes.addAndGet(-blob.size)))
    catch case NonFatal(error) => failed = Some(s"${error.getMessage}".linesIterator.next())

  private def write(rows: Vector[(Long, Record)]): Unit =
    for (table, some) <- rows.groupBy((_, record) => Table.of(record)) do
      val columns = table.columns.asInstanceOf[skein.record.Columns[Record]]
      val insert  = inserts.getOrElseUpdate(table.name, connection.prepareStatement(insertOf(table)))
      for (number, record) <- some do
        insert.setLong(1, number)
        columns.append(record, StatementRow(insert, connection, columns.definitions))
        insert.addBatch()
      insert.executeBatch(): Unit
    connection.commit()

  private def insertOf(table: Table[?]) =
    val width = table.columns.definitions.size + 1
    s"""INSERT INTO "$schema".${table.name} VALUES (${Vector.fill(width)("?").mkString(", ")})"""

object PostgresRowSink:
  /** Maximum number of rows that wait: about a minute at 20 vehicles and 10 Hz. */
  val Capacity = 65536

  /** Maximum number of bytes of waiting images and clouds. */
  val MostWaitingBytes: Long = 64L * 1024 * 1024

  private val BatchSize   = 1024
  private val PollMillis  = 50L
  private val CloseWithin = 10_000L

  /** Connects, and creates the tables. Blocks.
    *
    * @param url `postgres://USER:PASSWORD@HOST:PORT/DATABASE`
    * @return Left says why this failed, without the password
    */
  def open(url: String, heading: RecordingHeader): Either[String, PostgresRowSink] =
    for
      target     <- PostgresAddress.parse(url)
      connection <- attempt(target, target.connect())
      schema = schemaOf(heading.flight)
      made <- attempt(target, make(connection, schema, target)).left.map: why =>
        connection.close()
        why
    yield made

  /** A schema's name: flights with one name are distinguished by their start time. */
  private def schemaOf(flight: FlightRow): String =
    s"${flight.id.replaceAll("[^A-Za-z0-9_.-]", "_").take(40)}-${flight.startedAt.toNanos / 1_000_000}"

  private def make(connection: Connection, schema: String, target: PostgresAddress): PostgresRowSink =
    connection.setAutoCommit(false)
    Sql.execute(connection, s"""CREATE SCHEMA "$schema"""")
    Sql.execute(connection, s"""CREATE TABLE "$schema".format (version INTEGER NOT NULL)""")
    Sql.execute(connection, s"""INSERT INTO "$schema".format VALUES (${RecordingFormat.version})""")
    for table <- Table.all do
      val defined = table.numbered.map(column => column.copy(sqlType = typeOf(column.sqlType)).sql)
      Sql.execute(connection, s"""CREATE TABLE "$schema".${table.name} (${defined.mkString(", ")})""")
    connection.commit()
    PostgresRowSink(connection, schema, target)

  private[record] def typeOf(duckDb: String): String =
    duckDb.replace("DOUBLE", "DOUBLE PRECISION").replace("BLOB", "BYTEA")

  private def attempt[A](target: PostgresAddress, action: => A): Either[String, A] =
    try Right(action)
    catch
      case error: SQLException =>
        Left(s"Postgres at ${target.shown}: ${error.getMessage.linesIterator.next()}")

/** Sets the values of one row in the order of the columns; the first is the row's number. */
private final class StatementRow(insert: PreparedStatement, connection: Connection, columns: Vector[Column])
    extends RowWriter:
  private var place = 1

  private def next: Int =
    place += 1
    place

  private def array(kind: String, values: Vector[Any]): Unit =
    insert.setArray(next, connection.createArrayOf(kind, values.map(_.asInstanceOf[AnyRef]).toArray))

  def text(value: String): Unit             = insert.setString(next, value)
  def long(value: Long): Unit               = insert.setLong(next, value)
  def double(value: Double): Unit           = insert.setDouble(next, value)
  def longs(values: Vector[Long]): Unit     = array("bigint", values)
  def doubles(values: Vector[Double]): Unit = array("float8", values)
  def texts(values: Vector[String]): Unit   = array("text", values)
  def blob(value: Blob): Unit               = insert.setBytes(next, value.packed)

  // Typed, or else Postgres would prepare the statement again wherever other columns are null.
  def nothing(): Unit =
    val at = next
    insert.setNull(
      at,
      columns(at - 2).sqlType match
        case "VARCHAR"                   => Types.VARCHAR
        case "BIGINT"                    => Types.BIGINT
        case "DOUBLE"                    => Types.DOUBLE
        case kind if kind.endsWith("[]") => Types.ARRAY
        case other                       => throw IllegalArgumentException(s"column of type $other")
    )

/** The address of a Postgres database.
  *
  * @param shown the address without its password
  */
private[record] final case class PostgresAddress(jdbc: String, user: String, password: String, shown: String):
  def connect(): Connection = DriverManager.getConnection(jdbc, properties)

  private def properties: Properties =
    val properties = Properties()
    properties.setProperty("user", user)
    properties.setProperty("password", password)
    properties.setProperty("connectTimeout", PostgresAddress.ConnectSeconds)
    properties.setProperty("socketTimeout", "10")
    properties.setProperty("reWriteBatchedInserts", "true")
    properties

private[record] object PostgresAddress:
  private val ConnectSeconds = "5"

  /** A database's URL; an IPv6 address is in brackets. */
  private val Form =
    """postgres(?:ql)?://([^:@/]+)(?::([^@/]*))?@([^:/@]+|\[[^\]/@]+\])(?::(\d{1,5}))?/([^/?#]+)""".r

  def parse(url: String): Either[String, PostgresAddress] = url match
    case Form(user, password, host, port, database)
        if Option(port).forall(one => one.toInt >= 1 && one.toInt <= 65535) =>
      val at = s"$host:${Option(port).getOrElse("5432")}/$database"
      for
        name   <- decoded(user)
        secret <- decoded(Option(password).getOrElse(""))
      yield PostgresAddress(s"jdbc:postgresql://$at", name, secret, at)
    case _ => Left("expected postgres://USER:PASSWORD@HOST:PORT/DATABASE")

  /** Decodes percent-encoding, such as `%40` for `@` (RFC 3986). */
  private def decoded(text: String): Either[String, String] =
    try Right(URLDecoder.decode(text.replace("+", "%2B"), StandardCharsets.UTF_8))
    catch
      case _: IllegalArgumentException =>
        Left("expected two hexadecimal digits behind each % of user and password, %25 for % itself")
