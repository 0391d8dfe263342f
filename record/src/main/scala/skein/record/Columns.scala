package skein.record

import java.sql.{ResultSet, SQLException}
import scala.deriving.Mirror
import skein.policy.Action
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** How a value lies in one or more neighbouring columns: their names, and how to write and read them. */
private[record] trait Columns[A]:
  def definitions: Vector[Column]
  def append(value: A, to: RowWriter): Unit
  def read(cells: Cells): A

/** One column as the table defines it.
  *
  * @param older
  *   what gives its value in SQL where a file of an older format lacks the column or has it with another type
  */
private[record] final case class Column(
    name: String,
    sqlType: String,
    nullable: Boolean = false,
    older: Option[String] = None
):
  def isBlob: Boolean = sqlType == "BLOB"
  def sql: String     = s"$name $sqlType" + (if nullable then "" else " NOT NULL")

/** Walks over the cells of a result's current row from left to right. */
private[record] final class Cells(row: ResultSet):
  private var column = 0

  def next[A](read: (ResultSet, Int) => A): A =
    column += 1
    read(row, column)

  /** Reads `width` cells, or skips them if the first is null. */
  def nextOption[A](width: Int)(read: => A): Option[A] =
    if row.getObject(column + 1) == null then
      column += width
      None
    else Some(read)

private[record] object Columns:

  def text(name: String): Columns[String] = single(name, "VARCHAR", _.text(_), _.getString(_))

  def long(name: String): Columns[Long] = single(name, "BIGINT", _.long(_), _.getLong(_))

  def double(name: String): Columns[Double] = single(
    name,
    "DOUBLE",
    _.double(_),
    (row, column) =>
      val value = row.getDouble(column)
      if value.isFinite then value else throw SQLException(s"$name: expected a finite number, came $value")
  )

  def longs(name: String): Columns[Vector[Long]] =
    single(name, "BIGINT[]", _.longs(_), (row, column) => toLongs(row.getArray(column)))

  def doubles(name: String): Columns[Vector[Double]] =
    single(
      name,
      "DOUBLE[]",
      _.doubles(_),
      (row, column) =>
        listed(row.getArray(column)).map:
          case number: Number if number.doubleValue.isFinite => number.doubleValue
          case other => throw SQLException(s"$name: expected finite numbers, came $other")
    )

  def texts(name: String): Columns[Vector[String]] =
    single(name, "VARCHAR[]", _.texts(_), (row, column) => listed(row.getArray(column)).map(_.toString))

  /** Compressed by Zstandard. */
  def blob(name: String): Columns[Blob] = single(
    name,
    "BLOB",
    _.blob(_),
    (row, column) =>
      Blob.ofPacked(row.getBytes(column)).fold(why => throw SQLException(s"$name: $why"), identity)
  )

  private def listed(list: java.sql.Array): Vector[Object] =
    list.getArray.asInstanceOf[Array[Object]].toVector

  private def toLongs(list: java.sql.Array): Vector[Long] =
    listed(list).map:
      case number: Number => number.longValue
      case other          => throw SQLException(s"expected whole numbers in a list, came $other")

  def instantNs(name: String): Columns[Instant] = long(name + "Ns").as(Instant.ofNanos, _.toNanos)

  /** Exact up to 2^53 ns, 104 days. */
  def spanMs(name: String): Columns[Span] =
    double(name + "Ms").as(millis => Span.ofNanos(math.round(millis * 1e6)), _.toNanos / 1e6)

  def spanNs(name: String): Columns[Span] = long(name + "Ns").as(Span.ofNanos, _.toNanos)

  def metres(name: String): Columns[Metres] = double(name + "M").as(Metres(_), _.value)

  def speed(name: String): Columns[MetresPerSecond] = double(name + "Mps").as(MetresPerSecond(_), _.value)

  def radians(name: String): Columns[Radians] = double(name + "Rad").as(Radians(_), _.value)

  def eventKind(name: String): Columns[EventKind] = oneOf(name, EventKind.values)

  def endingKind(name: String): Columns[EndingKind] = oneOf(name, EndingKind.values)

  /** A case by its name. */
  private def oneOf[A](name: String, cases: Array[A]): Columns[A] = text(name).as(
    read =>
      cases
        .find(_.toString == read)
        .getOrElse(throw SQLException(s"$name: expected one of ${cases.mkString(", ")}, came '$read'")),
    _.toString
  )

  def ned(name: String, unit: String): Columns[Vector3] = product[Vector3]:
    (double(s"${name}North$unit"), double(s"${name}East$unit"), double(s"${name}Down$unit"))

  def frd(name: String, unit: String): Columns[Vector3] = product[Vector3]:
    (double(s"${name}Front$unit"), double(s"${name}Right$unit"), double(s"${name}Down$unit"))

  def quaternion(name: String): Columns[Quaternion] = product[Quaternion]:
    (double(name + "W"), double(name + "X"), double(name + "Y"), double(name + "Z"))

  val stampedKinematics: Columns[Stamped[Kinematics]] = product[Stamped[Kinematics]]:
    (
      product[Kinematics]:
        (
          ned("position", "M"),
          ned("velocity", "Mps"),
          quaternion("orientation"),
          frd("angularVelocity", "RadPerS")
        )
      ,
      instantNs("validAt"),
      instantNs("sentAt"),
      instantNs("receivedAt")
    )

  /** An action by its name and numbers: `actionX` to `actionZ` are north, east and down of a velocity, m/s, or of a place,
    * m; of [[Action.VelocityAt]] the third is an altitude, m; of [[Action.Attitude]] they are roll, pitch and yaw, rad,
    * and `actionAmount` is the thrust; else that is a speed, m/s. `actionYaw` is rad, or rad/s where it is `Turning`.
    */
  lazy val action: Columns[Action] =
    product[ActionCells]((
      text("action"),
      double("actionX"),
      double("actionY"),
      double("actionZ"),
      double("actionAmount"),
      text("actionYawMode"),
      double("actionYaw")
    )).as(_.action, ActionCells.of)

  /** The columns of a case class: those of its fields, one after the other. */
  def product[A <: Product](using
      mirror: Mirror.ProductOf[A]
  )(
      fields: Tuple.Map[mirror.MirroredElemTypes, Columns]
  ): Columns[A] =
    val parts = fields.toList.asInstanceOf[List[Columns[Any]]].toVector
    new Columns[A]:
      val definitions: Vector[Column]           = parts.flatMap(_.definitions)
      def append(value: A, to: RowWriter): Unit =
        for index <- parts.indices do parts(index).append(value.productElement(index), to)
      def read(cells: Cells): A = mirror.fromProduct(Tuple.fromArray(parts.map(_.read(cells)).toArray))

  /** All null where the value is absent. */
  def optional[A](columns: Columns[A]): Columns[Option[A]] = new Columns[Option[A]]:
    val definitions: Vector[Column]                   = columns.definitions.map(_.copy(nullable = true))
    def append(value: Option[A], to: RowWriter): Unit = value match
      case Some(present) => columns.append(present, to)
      case None          => definitions.foreach(_ => to.nothing())
    def read(cells: Cells): Option[A] = cells.nextOption(definitions.size)(columns.read(cells))

  /** Optional columns of later formats. Where they are absent they are left out of the [[Digest]], so that it is that of
    * the formats before.
    */
  def added[A](columns: Columns[Option[A]]): Columns[Option[A]] = new Columns[Option[A]]:
    val definitions: Vector[Column]                   = columns.definitions
    def append(value: Option[A], to: RowWriter): Unit =
      if value.isEmpty then definitions.foreach(_ => to.nothingYet()) else columns.append(value, to)
    def read(cells: Cells): Option[A] = columns.read(cells)

  /** A column that a file of an older format has in another way. */
  def migrated[A](columns: Columns[A], older: String): Columns[A] = new Columns[A]:
    val definitions: Vector[Column]           = columns.definitions.map(_.copy(older = Some(older)))
    def append(value: A, to: RowWriter): Unit = columns.append(value, to)
    def read(cells: Cells): A                 = columns.read(cells)

  /** Puts a word before every name: `validAtNs` becomes `ownValidAtNs`. */
  def prefixed[A](prefix: String, columns: Columns[A]): Columns[A] = new Columns[A]:
    val definitions: Vector[Column] =
      columns.definitions.map(column => column.copy(name = prefix + column.name.capitalize))
    def append(value: A, to: RowWriter): Unit = columns.append(value, to)
    def read(cells: Cells): A                 = columns.read(cells)

  private def single[A](
      name: String,
      sqlType: String,
      write: (RowWriter, A) => Unit,
      get: (ResultSet, Int) => A
  ): Columns[A] = new Columns[A]:
    val definitions: Vector[Column]           = Vector(Column(name, sqlType))
    def append(value: A, to: RowWriter): Unit = write(to, value)
    def read(cells: Cells): A                 = cells.next(get)

  extension [A](columns: Columns[A])
    private def as[B](from: A => B, to: B => A): Columns[B] = new Columns[B]:
      val definitions: Vector[Column]            = columns.definitions
      def append(value: B, row: RowWriter): Unit = columns.append(to(value), row)
      def read(cells: Cells): B                  = from(columns.read(cells))
