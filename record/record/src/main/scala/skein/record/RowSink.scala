package skein.record

/** Receives a flight's rows in addition to its recording: the rows committed there, in order, with their
  * numbers. Called by one thread at a time, which is not a control thread. A failure is kept as [[failure]],
  * and the recording continues without the sink.
  */
trait RowSink:
  /** Takes rows. May take some milliseconds, in which the recording's queue grows. */
  def put(rows: Seq[(Long, Record)]): Unit

  def close(): Unit

  /** Deletes the output, since there was no flight; after [[close]]. */
  def discard(): Unit

  /** The reason why the sink failed, in one line; None if it has not failed. */
  def failure: Option[String]
