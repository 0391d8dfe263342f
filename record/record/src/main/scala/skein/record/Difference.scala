package skein.record

/** The first value in which two recordings differ.
  *
  * @param where the row, for example `decision 17 of Pursuer`
  * @param column name of the column in the row's table
  */
final case class Difference(where: String, column: String, recorded: String, again: String):
  def message: String = s"$where: $column was $recorded, is $again"

object Difference:

  /** Compares two sequences of records in order, column by column, to the last bit. */
  def first(recorded: Iterable[Record], again: Iterable[Record]): Option[Difference] =
    val rows = recorded.iterator.map(Some(_)).zipAll(again.iterator.map(Some(_)), None, None)
    rows.collectFirst(Function.unlift:
      case (Some(one), Some(other)) => between(one, other)
      case (Some(one), None)        => Some(Difference(nameOf(one), "the row", "there", "missing"))
      case (None, Some(other))      => Some(Difference(nameOf(other), "the row", "missing", "there"))
      case (None, None)             => None)

  def between(recorded: Record, again: Record): Option[Difference] =
    val (before, now) = (Table.of(recorded), Table.of(again))
    if before != now then Some(Difference(nameOf(recorded), "the table", before.name, now.name))
    else
      before.columns.definitions
        .map(_.name)
        .lazyZip(cells(recorded))
        .lazyZip(cells(again))
        .collectFirst:
          case (column, one, other) if one != other => Difference(nameOf(recorded), column, one, other)

  private def nameOf(record: Record): String = record match
    case decision: DecisionRow => s"decision ${decision.sequence} of ${decision.vehicle}"
    case read: MeasurementRow  => s"measurement ${read.sequence} of ${read.vehicle}'s ${read.sensor}"
    case reading: ReadingRow   => s"reading ${reading.sequence} of ${reading.vehicle}"
    case command: CommandRow   => s"command ${command.sequence} to ${command.vehicle}"
    case other                 => s"a row of ${Table.of(other).name}"

  /** The cells as texts; different doubles have different shortest texts. */
  private def cells(record: Record): Vector[String] =
    val cells = Vector.newBuilder[String]
    val row   = new RowWriter:
      def text(value: String): Unit             = cells += value
      def long(value: Long): Unit               = cells += value.toString
      def double(value: Double): Unit           = cells += value.toString
      def longs(values: Vector[Long]): Unit     = cells += values.mkString(",")
      def doubles(values: Vector[Double]): Unit = cells += values.mkString(",")
      def texts(values: Vector[String]): Unit   = cells += values.mkString(",")
      def blob(value: Blob): Unit               = cells += s"${value.size} bytes, CRC ${Blob.crc(value)}"
      def nothing(): Unit                       = cells += "absent"
    Table.columnsOf(record).append(record, row)
    cells.result()
