package skein.python

import java.nio.file.{Files, Path}
import scala.concurrent.duration.*
import scala.sys.process.{Process, ProcessLogger}

/** Runs the package's own tests, where a Python has what they need and the commands are built. */
class PythonPackageLiveSuite extends munit.FunSuite:
  override val munitTimeout: Duration = 5.minutes

  test("the Python package passes its tests"):
    val root = Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at =>
      Files.exists(at.resolve("sbtw"))
    ).get
    val needed = ran(root, "python3", "-c", "import duckdb, gymnasium, jpype, pandas, pettingzoo, pytest")
    assume(
      needed.isRight,
      s"python3 lacks a package: ${needed.swap.getOrElse("").linesIterator.toSeq.lastOption.getOrElse("")}"
    )
    assume(
      Files.exists(root.resolve("cli/target/universal/stage/bin/skein")),
      "./sbtw cli/stage was not run before"
    )
    assertEquals(ran(root, "python3", "-m", "pytest", "-q", "python"), Right(()))

  private def ran(in: Path, command: String*): Either[String, Unit] =
    val output = StringBuilder()
    val log    = ProcessLogger(line => output.append(line).append('\n'): Unit)
    try Either.cond(Process(command, in.toFile).!(log) == 0, (), output.toString)
    catch case missing: java.io.IOException => Left(missing.getMessage)
