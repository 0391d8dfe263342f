package skein.cli

import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import skein.testing.{Conclusive, Lengthy, TemporaryFolders}

/** `decide` and `fly` as two programs started by the staged launcher script: tests within one process cannot
  * see mistakes in its command lines.
  */
class StartedSolverLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Conclusive:
  private lazy val scratch = temporaryFolder()

  private def started(name: String, words: String*): (Process, Path) =
    val log = scratch.resolve(s"$name.log")
    (Launchers.start(Launchers.staged, log, words), log)

  /** Polls the log of the other process for its address. */
  private def addressIn(log: Path, of: Process): String =
    val said     = """decides at (tcp://\S+);""".r
    val deadline = System.nanoTime + TimeUnit.MINUTES.toNanos(2)
    def found    = said.findFirstMatchIn(Files.readString(log)).map(_.group(1))
    while found.isEmpty && of.isAlive && System.nanoTime < deadline do Thread.sleep(20)
    found.getOrElse(fail(s"no address in what the solver said: ${Files.readString(log)}"))

  test("a solver in another process plans a flight's manoeuvres, with the JDK's vector module"):
    assume(Files.exists(Launchers.staged), "./sbtw cli/stage makes the launcher")
    conclusive:
      val (solver, solverLog) = started("decide", "decide", "--at", "tcp://127.0.0.1:0")
      try
        val (flight, flightLog) = started(
          "fly",
          ("fly --loop plan --link none --duration 3s --deadline 400ms --twins 0 --solver " +
            addressIn(solverLog, solver) + " --out " + scratch.resolve("flown")).split(' ')*
        )
        try assert(flight.waitFor(3, TimeUnit.MINUTES), Files.readString(flightLog))
        finally flight.destroyForcibly(): Unit
        val told = Files.readString(flightLog)
        assertEquals(flight.exitValue, 0, told)
        assert(clue(told).contains("plan, solver"))
        assert(!told.contains("jdk.incubator.vector,"), told)
        assert(clue(Files.readString(solverLog)).contains("has ended"))
      finally solver.destroyForcibly(): Unit
