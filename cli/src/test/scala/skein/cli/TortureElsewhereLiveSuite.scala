package skein.cli

import java.nio.file.Files
import skein.testing.{Lengthy, TemporaryFolders}

/** Flights through faults by processes of this machine, over loopback. Like this JVM they spare optimising, which takes
  * more of the processor's time than such flights.
  */
class TortureElsewhereLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:
  test(
    "flights are flown by two processes, each once, and not again by the same command, which starts nobody"
  ):
    val out   = temporaryFolder()
    val words = "torture --seeds 4 --duration 8s --workers 2 --out".split(' ').toSeq :+ out.toString
    for found <- Seq("2 blocks counted, 0 more", "0 blocks counted, 2 more") do
      val ran = Ran.of(Main.run(words))
      assertEquals(ran.status, 0, ran.said)
      assert(clue(ran.said).contains(found))
      assert(ran.said.contains("4 of 4 flights of 8s, 0 failed"))
      for worker <- 1 to 2 do
        val isNeeded = found.startsWith("2")
        assertEquals(
          Files.deleteIfExists(out.resolve(s"worker-$worker.log")),
          isNeeded,
          s"worker $worker: $found"
        )
