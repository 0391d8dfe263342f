package skein.record

import java.sql.{Connection, ResultSet}
import scala.util.Using

/** Statements of SQL, each closed when it has run. */
private[record] object Sql:
  def execute(connection: Connection, sql: String): Unit =
    Using.resource(connection.createStatement())(_.execute(sql)): Unit

  /** The rows of a query; `read` reads the present one. */
  def rows[A](connection: Connection, query: String)(read: ResultSet => A): Vector[A] =
    Using.resource(connection.createStatement()): statement =>
      Using.resource(statement.executeQuery(query)): rows =>
        Vector.unfold(rows)(rows => Option.when(rows.next())((read(rows), rows)))

  /** A text as a literal, with its quotes doubled. */
  def quoted(text: String): String = "'" + text.replace("'", "''") + "'"
