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

  test("if Zstandard's library cannot be loaded, it is named, at its first use and later"):
    val first = UnsatisfiedLinkError("no room")
    first.setStackTrace(Array(StackTraceElement(
      "com.github.luben.zstd.util.Native",
      "load",
      "Native.java",
      1
    )))
    val later = NoClassDefFoundError("Could not initialize class com.github.luben.zstd.Zstd")
    for error <- Seq(first, later) do
      assert(told(error).left.exists(_.contains("Zstandard's library cannot be loaded: ")), told(error))
