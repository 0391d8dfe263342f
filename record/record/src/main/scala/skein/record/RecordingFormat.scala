package skein.record

import java.sql.Connection
import scala.util.Using

/** The versions of recordings' tables. */
object RecordingFormat:

  /** Counts changes of the tables; a file of a later version is not read. */
  val version = 7

  /** The oldest version that can be read; later additions read as absent. */
  val oldest = 2

  private[record] def of(connection: Connection): Int =
    Using.resource(connection.createStatement()): statement =>
      Using.resource(statement.executeQuery("SELECT max(version) FROM format")): rows =>
        val _ = rows.next()
        rows.getInt(1)
