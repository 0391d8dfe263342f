package skein.record

import java.sql.Connection
import scala.util.Using

/** Versions of a recording's tables. */
object RecordingFormat:

  /** Counts changes of the tables; a file of a later version is not read. */
  val version = 7

  /** Files since this version are read: what came later reads as absent. */
  val oldest = 2

  /** A file's. */
  private[record] def of(connection: Connection): Int =
    Using.resource(connection.createStatement()): statement =>
      Using.resource(statement.executeQuery("SELECT max(version) FROM format")): rows =>
        val _ = rows.next()
        rows.getInt(1)
