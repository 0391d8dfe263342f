package skein.cli

import java.io.{ByteArrayOutputStream, IOException, OutputStream, PrintStream}
import java.nio.file.{Files, Path}
import skein.testing.TemporaryFolders

class OutputSuite extends munit.FunSuite, TemporaryFolders:
  private def broken(why: String): OutputStream = _ => throw IOException(why)

  private def status(why: String): (Int, String) =
    val lost = PrintStream(broken(why))
    lost.println("a table")
    val told = ByteArrayOutputStream()
    (Console.withErr(told)(Main.written(lost, broken(why))), told.toString)

  test("output that could not be written is an error, except into a pipe that its reader closed"):
    assertEquals(Main.written(PrintStream(ByteArrayOutputStream()), broken("unused")), 0)
    assertEquals(
      status("No space left on device"),
      (1, "skein: cannot write to standard output: No space left on device\n")
    )
    assertEquals(status("Broken pipe"), (0, ""))

  test("only one command at a time writes to a folder"):
    val folder = temporaryFolder()
    val both   = OutFolder.alone(folder)(Right(OutFolder.alone(folder)(Right(1))))
    assert(clue(both).exists(_.left.exists(_.contains("another command is at work"))))
    assertEquals(OutFolder.alone(folder)(Right(2)), Right(2))

  test("a refused command leaves no folder that it created and did not use"):
    val folder                                                           = temporaryFolder()
    def refused(name: String)(write: Path => Unit): Either[String, Unit] = OutFolder.unlessRefused:
      OutFolder.made("--out", s"$folder/$name").flatMap: made =>
        write(made)
        Left("nobody answers")
    Files.createDirectory(folder.resolve("there")): Unit
    assertEquals(refused("there")(_ => ()), Left("nobody answers"))
    assertEquals(refused("new/dated")(_ => ()), Left("nobody answers"))
    assertEquals(
      refused("locked")(OutFolder.alone(_)(Left("nobody answers")): Unit),
      Left("nobody answers")
    )
    assertEquals(refused("gone")(Files.delete), Left("nobody answers"))
    assertEquals(refused("used")(made => Files.createFile(made.resolve("log")): Unit), Left("nobody answers"))
    assertEquals(folder.toFile.list.toSet, Set("there", "used"))
    assertEquals(OutFolder.unlessRefused(OutFolder.made("--out", s"$folder/kept")).map(_ => ()), Right(()))
    assert(Files.exists(folder.resolve("kept")))

  test("a user who ends virtual flights is shown how many are recorded"):
    assertEquals(
      FlyCommand.recorded(0, 1, Path.of("f")),
      "none of 1 flight has ended, and nothing is recorded"
    )
    assertEquals(
      FlyCommand.recorded(1, 3, Path.of("f")),
      "1 of 3 flights have ended and are recorded, the rest is not; ./skein report f/*.duckdb shows them"
    )

  test("a flight without a decision is an error, unless the user ended it before"):
    val decisions = Seq("stream-vpn" -> 0, "futures-vpn" -> 12, "predictive-vpn" -> 0)
    val told      = FlyCommand.undecided(decisions, ended = Set("predictive-vpn"))
    assert(told.left.exists(_.startsWith("nothing was decided in stream-vpn: ")), told.toString)
    assertEquals(FlyCommand.undecided(decisions, ended = Set("predictive-vpn", "stream-vpn")), Right(()))
