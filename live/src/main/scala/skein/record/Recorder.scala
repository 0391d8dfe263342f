package skein.record

import scala.concurrent.Future

/** Takes down what a flight does. */
trait Recorder:

  /** Takes one record; never blocks, from any thread. A record that cannot be kept makes [[failure]] complete; after
    * a failure or [[close]], records are ignored.
    */
  def offer(record: Record): Unit

  /** Completes when a record could not be kept, and never otherwise. The flight must end then: vehicles hover, and
    * the reason is shown.
    */
  def failure: Future[RecordError]

  /** Writes what is still queued and closes. Completes with the number of rows written, or with the failure. Every
    * call has the same result.
    */
  def close(): Future[Either[RecordError, Written]]

/** What a recording holds once closed: rows by table, tables without rows left out. */
final case class Written(rows: Map[String, Long]):
  def total: Long = rows.values.sum

  private[record] def ++(records: Seq[Record]): Written =
    val more = records.groupMapReduce(Table.of(_).name)(_ => 1)(_ + _)
    Written(more.foldLeft(rows):
      case (rows, (table, count)) => rows.updated(table, rows.getOrElse(table, 0L) + count))

private[record] object Written:
  val nothing: Written = Written(Map.empty)

/** What a recording begins with; on disk before the first record is taken. */
final case class Heading(flight: Flight, vehicles: Seq[Vehicle], parameters: Seq[Parameter] = Nil):
  def records: Seq[Record] = flight +: (vehicles ++ parameters)

  /** The parameters whose names begin with a word and a full stop, by what follows. */
  def parametersOf(word: String): Map[String, String] =
    parameters
      .collect { case Parameter(s"$before.$name", value) if before == word => name -> value }
      .toMap
