package skein.cli

import java.nio.file.Path
import skein.testing.Unhurried

/** Programs that are ended while they run, each in a process of its own. */
class EdgeLiveSuite extends munit.FunSuite, Unhurried:

  for place <- Seq("main", "virtual") do
    test(s"when user code ends the program on a $place thread, that and the progress are reported"):
      val java    = Path.of(sys.props("java.home"), "bin", "java").toString
      val words   = Seq(java, "-cp", sys.props("java.class.path"), "skein.cli.endsItself", place)
      val process = ProcessBuilder(words*).redirectErrorStream(true).start()
      val said    = String(process.getInputStream.readAllBytes()).linesIterator.toSet
      assertEquals(process.waitFor(), 3)
      assert(
        clue(said).exists(_.matches("skein: ended by System.exit in EdgeLiveSuite.scala:\\d+")) &&
          said.contains("skein: 1 of 2 flights have ended")
      )
      assertEquals(said.size, 2)

@main def endsItself(place: String): Unit =
  Edge.tellingExit(Edge.tellingIfCut("1 of 2 flights have ended"):
    // A program that has run for a while.
    System.gc()
    if place == "main" then sys.exit(3)
    else Thread.ofVirtual().start(() => sys.exit(3)).join())
