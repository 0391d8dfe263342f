package skein.record

import java.nio.file.Path
import java.sql.SQLException

class RecordingFileSuite extends munit.FunSuite:
  private def told(failure: Throwable) =
    RecordingFile.attempt(RecordError.WriteFailed(Path.of("x.duckdb"), _))(throw failure).left.map(_.message)

  test("the first line of a database's exception is reported"):
    assert(told(SQLException("no room left\nat the third page")).left.exists(_.endsWith("no room left")))

  test("if the database's library cannot be loaded, the deepest cause is reported"):
    val deepest = java.io.IOException("permission denied\nfor /tmp/x")
    val error   = told(ExceptionInInitializerError(RuntimeException("while it was unpacked", deepest)))
    assert(
      error.left.exists(_.endsWith("the database's library cannot be loaded: permission denied")),
      s"$error"
    )
