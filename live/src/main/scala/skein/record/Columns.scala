package skein.record

import java.sql.ResultSet
import scala.deriving.Mirror
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** How a value lies in one or more neighbouring columns: their names, and how to write and read them. */
private[record] trait Columns[A]:
  def definitions: Vector[Column]
  def append(value: A, to: RowWriter): Unit
  def read(cells: Cells): A

/** One column as the table defines it. */
private[record] final case class Column(name: String, sqlType: String, nullable: Boolean = false):
  def sql: String = s"$name $sqlType" + (if nullable then "" else " NOT NULL")

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

  def double(name: String): Columns[Double] = single(name, "DOUBLE", _.double(_), _.getDouble(_))

  def instantNs(name: String): Columns[Instant] = long(name + "Ns").as(Instant.ofNanos, _.toNanos)

  /** Exact up to 2^53 ns, 104 days. */
  def spanMs(name: String): Columns[Span] =
    double(name + "Ms").as(millis => Span.ofNanos(math.round(millis * 1e6)), _.toNanos / 1e6)

  def spanNs(name: String): Columns[Span] = long(name + "Ns").as(Span.ofNanos, _.toNanos)

  def metres(name: String): Columns[Metres] = double(name + "M").as(Metres(_), _.value)

  def speed(name: String): Columns[MetresPerSecond] = double(name + "Mps").as(MetresPerSecond(_), _.value)

  def radians(name: String): Columns[Radians] = double(name + "Rad").as(Radians(_), _.value)

  def eventKind(name: String): Columns[EventKind] = text(name).as(EventKind.valueOf, _.toString)

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
