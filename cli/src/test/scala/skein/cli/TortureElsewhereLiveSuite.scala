package skein.cli

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Files
import scala.concurrent.duration.*

/** Flights through faults by processes of this machine, over loopback. Like this JVM they spare optimising, which takes
  * more of the processor's time than such flights.
  */
class TortureElsewhereLiveSuite extends munit.FunSuite:
  override val munitTimeout: Duration = 10.minutes

  test(
    "flights are flown by two processes, each once, and not again by the same command, which starts nobody"
  ):
    val out   = Files.createTempDirectory("torture")
    val words = "torture --seeds 4 --duration 12s --workers 2 --out".split(' ').toSeq :+ out.toString
    for found <- Seq("2 blocks counted, 0 more", "0 blocks counted, 2 more") do
      val said   = ByteArrayOutputStream()
      val status = Console.withOut(said)(Console.withErr(said)(Main.run(words)))
      assertEquals(status, 0, said.toString(UTF_8))
      assert(clue(said.toString(UTF_8)).contains(found))
      assert(said.toString(UTF_8).contains("4 of 4 flights of 12s, 0 failed"))
      for worker <- 1 to 2 do
        val isNeeded = found.startsWith("2")
        assertEquals(
          Files.deleteIfExists(out.resolve(s"worker-$worker.log")),
          isNeeded,
          s"worker $worker: $found"
        )
