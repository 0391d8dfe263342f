import java.io.{ByteArrayOutputStream, PrintStream}
import java.nio.file.{Files, Path}
import scala.concurrent.duration.*
import scala.util.Using

/** Runs the README's first program by the README's command: its output equals the README's. */
class ChaseSimulation extends munit.FunSuite:
  override val munitTimeout: Duration = 3.minutes

  private val readme = Files.readString(
    Iterator
      .iterate(Path.of("").toAbsolutePath)(_.getParent)
      .find(path => Files.exists(path.resolve("build.sbt")))
      .get
      .resolve("README.md")
  )

  private val (command, shown) =
    """(?s)```\n\./sbtw "chase/run ([^"]+)"\n```\n+```\n(.*?)\n```""".r
      .findFirstMatchIn(readme)
      .map(found => (found.group(1), found.group(2)))
      .getOrElse(fail("the README does not show how to run it"))

  test("it prints what the README shows"):
    val out    = Files.createTempDirectory("chase")
    val said   = ByteArrayOutputStream()
    val stream = PrintStream(said, true)
    try
      val status = Console.withOut(stream)(Console.withErr(stream)(
        Main.run(command.split(' ').toSeq ++ Seq("--out", out.toString))
      ))
      assertEquals(status, 0, said.toString)
      val printed = said.toString.linesIterator.map(_.stripTrailing).toVector
      val lines   = shown.linesIterator.map(_.stripTrailing).filterNot(_ == "…").toVector
      assert(lines.sizeIs > 5, shown)
      assertEquals(lines.filterNot(printed.contains), Vector.empty, said.toString)
    finally
      Using.resource(Files.walk(out))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
