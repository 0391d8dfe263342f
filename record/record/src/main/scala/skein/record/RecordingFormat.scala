package skein.record

import java.sql.Connection

/** The versions of recordings' tables. */
object RecordingFormat:

  /** Counts changes of the tables; a file of a later version is not read. */
  val version = 7

  /** The oldest version that can be read; later additions read as absent. */
  val oldest = 2

  private[record] def of(connection: Connection): Int =
    Sql.rows(connection, "SELECT max(version) FROM format")(_.getInt(1)).head
