package skein.record

/** Takes a flight's rows beside its recording: those that are committed there, in their order, with their
  * numbers. Called by one thread at a time, which is none of control's. What goes wrong is kept until
  * somebody asks: the recording goes on without it.
  */
trait RowSink:
  /** May take some milliseconds, in which the recording's queue grows. */
  def put(rows: Seq[(Long, Record)]): Unit

  /** Ends it. */
  def close(): Unit

  /** Takes away what was written, since there was no flight; after [[close]]. */
  def discard(): Unit

  /** What went wrong, in a line for a person. */
  def failure: Option[String]
