package skein.record

import java.sql.{ResultSet, SQLException}
import java.util.Locale
import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.policy.Action
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** The layout of a value in one or more adjacent columns: their names, and how to write and read them. */
private[record] trait Columns[A]:
  def definitions: Vector[Column]
  def append(value: A, to: RowWriter): Unit
  def read(cells: Cells): A

/** One column of a table.
  *
  * @param older SQL expression of the value, for files of older formats that lack the column or give it
  *   another type
  */
private[record] final case class Column(
    name: String,
    sqlType: String,
    nullable: Boolean = false,
    older: Option[String] = None
):
  def isBlob: Boolean = sqlType == "BLOB"
  def sql: String     = s"$name $sqlType" + (if nullable then "" else " NOT NULL")

/** Iterates over the cells of a result's current row from left to right. */
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

/** The layout of a field of a type, by the field's name: column names append the unit to it. */
private[record] trait FieldColumns[A]:
  def apply(name: String): Columns[A]

private[record] object FieldColumns:
  import Columns.*

  given FieldColumns[String] = single(_, "VARCHAR", _.text(_), _.getString(_))

  given long: FieldColumns[Long] = single(_, "BIGINT", _.long(_), _.getLong(_))

  given double: FieldColumns[Double] = name =>
    single(
      name,
      "DOUBLE",
      _.double(_),
      (row, column) =>
        val value = row.getDouble(column)
        if value.isFinite then value
        else throw SQLException(s"$name: expected a finite number, got $value")
    )

  given longs: FieldColumns[Vector[Long]] = name =>
    single(
      name,
      "BIGINT[]",
      _.longs(_),
      (row, column) =>
        listed(row.getArray(column)).map:
          case number: Number => number.longValue
          case other          => throw SQLException(s"expected whole numbers in a list, got $other")
    )

  given doubles: FieldColumns[Vector[Double]] = name =>
    single(
      name,
      "DOUBLE[]",
      _.doubles(_),
      (row, column) =>
        listed(row.getArray(column)).map:
          case number: Number if number.doubleValue.isFinite => number.doubleValue
          case other => throw SQLException(s"$name: expected finite numbers, got $other")
    )

  given texts: FieldColumns[Vector[String]] =
    single(_, "VARCHAR[]", _.texts(_), (row, column) => listed(row.getArray(column)).map(_.toString))

  /** Bytes, compressed by Zstandard. */
  given FieldColumns[Blob] = name =>
    single(
      name,
      "BLOB",
      _.blob(_),
      (row, column) =>
        Blob.ofPacked(row.getBytes(column)).fold(why => throw SQLException(s"$name: $why"), identity)
    )

  given FieldColumns[Instant] = name => long(name + "Ns").as(Instant.ofNanos, _.toNanos)

  /** Milliseconds, exact up to 2^53 ns, 104 days; clock offsets may be larger. */
  given FieldColumns[Span] = name =>
    if name.endsWith("Offset") then long(name + "Ns").as(Span.ofNanos, _.toNanos)
    else double(name + "Ms").as(millis => Span.ofNanos(math.round(millis * 1e6)), _.toNanos / 1e6)

  given FieldColumns[Metres] = name => double(name + "M").as(Metres(_), _.value)

  given FieldColumns[MetresPerSecond] = name => double(name + "Mps").as(MetresPerSecond(_), _.value)

  given FieldColumns[Radians] = name => double(name + "Rad").as(Radians(_), _.value)

  given FieldColumns[EventKind] = oneOf(_, EventKind.values)

  given FieldColumns[EventSubject] = oneOf(_, EventSubject.values)

  given FieldColumns[EndingKind] = oneOf(_, EndingKind.values)

  given FieldColumns[Simulator] = summon[FieldColumns[String]](_).as(Simulator.ofLabel, _.label)

  /** In formats up to 6, the error's text replaces `failed`. */
  given FieldColumns[CommandOutcome] = name =>
    given FieldColumns[Option[String]] = error => added(optional(summon[FieldColumns[String]](error)))
    columns[OutcomeCells](name, "error").as(_.outcome, OutcomeCells.of)

  /** Three columns, whose names have a direction in place of the frame at the end of the field's name:
    * `velocityNed` becomes `velocityNorthMps`, `velocityEastMps` and `velocityDownMps`.
    */
  given FieldColumns[Vector3] = name =>
    val unit =
      if name.startsWith("angularVelocity") then "RadPerS"
      else if name.toLowerCase(Locale.ROOT).contains("velocity") then "Mps"
      else "M"
    val (quantity, directions) =
      if name.endsWith("Frd") then (name.stripSuffix("Frd"), Seq("Front", "Right", "Down"))
      else (name.stripSuffix("Ned"), Seq("North", "East", "Down"))
    columns[Vector3](directions.map(direction => s"$quantity$direction$unit")*)

  given FieldColumns[Quaternion] = name => columns[Quaternion](Seq("W", "X", "Y", "Z").map(name + _)*)

  given FieldColumns[Kinematics] = _ => columns[Kinematics]()

  given FieldColumns[Stamped[Kinematics]] = _ => columns[Stamped[Kinematics]]()

  given FieldColumns[ReadingRow] = prefixed(_, columns[ReadingRow]())

  given FieldColumns[Observations] = _ => columns[Observations]()

  given FieldColumns[TrueAge] = _ =>
    columns[TrueAge]("ownTrueAge", "opponentTrueAge", "clockOffset", "uncertainty")

  given FieldColumns[Predicted] = _ =>
    columns[Predicted](
      "actsAt",
      "ownPredictedPositionNed",
      "ownPredictedVelocityNed",
      "opponentPredictedPositionNed",
      "opponentPredictedVelocityNed"
    )

  given FieldColumns[PredictedMotion] = prefixed(_, columns[PredictedMotion]())

  given FieldColumns[PlannedPath] = _ => columns[PlannedPath]("courseNorthM", "courseEastM", "courseStep")

  given FieldColumns[PlannedStates] = _ => columns[PlannedStates]("ownState", "opponentState")

  given FieldColumns[SolverClock] = _ => columns[SolverClock]("solverClockOffset", "solverClockUncertainty")

  /** An action, by its name and components. `actionX` to `actionZ` are a velocity (north, east, down; m/s) or
    * a position (north, east, down; m); the third is an altitude (m) for [[Action.VelocityAt]]. For
    * [[Action.Attitude]] they are roll, pitch and yaw (rad), and `actionAmount` is the thrust; for other
    * actions `actionAmount` is a speed (m/s). `actionYaw` is in rad, or in rad/s for `Turning`.
    */
  given FieldColumns[Action] = _ =>
    columns[ActionCells](
      "action",
      "actionX",
      "actionY",
      "actionZ",
      "actionAmount",
      "actionYawMode",
      "actionYaw"
    ).as(_.action, ActionCells.of)

  given option[A](using one: FieldColumns[A]): FieldColumns[Option[A]] = name => optional(one(name))

  private def listed(list: java.sql.Array): Vector[Object] =
    list.getArray.asInstanceOf[Array[Object]].toVector

  private def oneOf[A](name: String, cases: Array[A]): Columns[A] = summon[FieldColumns[String]](name).as(
    read =>
      cases
        .find(_.toString == read)
        .getOrElse(throw SQLException(s"$name: expected one of ${cases.mkString(", ")}, got '$read'")),
    _.toString
  )

  private def single[A](
      name: String,
      sqlType: String,
      write: (RowWriter, A) => Unit,
      get: (ResultSet, Int) => A
  ): Columns[A] = new Columns[A]:
    val definitions: Vector[Column]           = Vector(Column(name, sqlType))
    def append(value: A, to: RowWriter): Unit = write(to, value)
    def read(cells: Cells): A                 = cells.next(get)

private[record] object Columns:

  /** The columns of a case class: those of its fields, one after the other.
    *
    * @param names replacements for the fields' names, if any
    */
  inline def columns[A](names: String*)(using mirror: Mirror.ProductOf[A]): Columns[A] =
    ofFields(
      mirror,
      names,
      constValueTuple[mirror.MirroredElemLabels],
      summonAll[Tuple.Map[mirror.MirroredElemTypes, FieldColumns]]
    )

  private[record] def ofFields[A](
      mirror: Mirror.ProductOf[A],
      names: Seq[String],
      labels: Tuple,
      fields: Tuple
  ): Columns[A] =
    val named = if names.isEmpty then labels.productIterator.map(_.toString) else names.iterator
    val parts = fields.productIterator.zip(named).map(_.asInstanceOf[FieldColumns[Any]](_)).toVector
    new Columns[A]:
      val definitions: Vector[Column]           = parts.flatMap(_.definitions)
      def append(value: A, to: RowWriter): Unit =
        for index <- parts.indices do
          parts(index).append(value.asInstanceOf[Product].productElement(index), to)
      def read(cells: Cells): A = mirror.fromProduct(Tuple.fromArray(parts.map(_.read(cells)).toArray))

  /** Columns of an optional value: all null if it is absent. */
  def optional[A](columns: Columns[A]): Columns[Option[A]] = new Columns[Option[A]]:
    val definitions: Vector[Column]                   = columns.definitions.map(_.copy(nullable = true))
    def append(value: Option[A], to: RowWriter): Unit = value match
      case Some(present) => columns.append(present, to)
      case None          => definitions.foreach(_ => to.nothing())
    def read(cells: Cells): Option[A] = cells.nextOption(definitions.size)(columns.read(cells))

  /** Optional columns that earlier formats lack. Absent values are left out of the [[Digest]], so that it
    * equals the digest in an earlier format.
    */
  def added[A](columns: Columns[Option[A]]): Columns[Option[A]] = new Columns[Option[A]]:
    export columns.{definitions, read}
    def append(value: Option[A], to: RowWriter): Unit =
      if value.isEmpty then definitions.foreach(_ => to.nothingYet()) else columns.append(value, to)

  /** A column that a file of an older format stores in another form. */
  def migrated[A](columns: Columns[A], older: String): Columns[A] =
    redefined(columns)(_.copy(older = Some(older)))

  /** Columns with a prefix before every name: `validAtNs` becomes `ownValidAtNs`. */
  def prefixed[A](prefix: String, columns: Columns[A]): Columns[A] =
    redefined(columns)(column => column.copy(name = prefix + column.name.capitalize))

  private def redefined[A](columns: Columns[A])(change: Column => Column): Columns[A] = new Columns[A]:
    val definitions: Vector[Column] = columns.definitions.map(change)
    export columns.{append, read}

  extension [A](columns: Columns[A])
    def as[B](from: A => B, to: B => A): Columns[B] = new Columns[B]:
      val definitions: Vector[Column]            = columns.definitions
      def append(value: B, row: RowWriter): Unit = columns.append(to(value), row)
      def read(cells: Cells): B                  = from(columns.read(cells))
