package skein.cli

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.blocks.Ledger
import skein.testing.{Lengthy, TemporaryFolders}

/** Flights and lessons by processes of this machine, over loopback. Like this JVM they skip optimising
  * compilation, which takes more processor time than these few flights.
  */
class ElsewhereLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:

  private def ran(words: String, out: Path): String =
    val ran = Ran.of(Main.run(words.split(' ').toSeq ++ Seq("--out", out.toString)))
    assertEquals(ran.status, 0, ran.said)
    ran.said

  test(
    "two processes run each flight with faults once, and the repeated command runs none and starts no worker"
  ):
    val out = temporaryFolder()
    for found <- Seq("2 blocks counted, 0 more", "0 blocks counted, 2 more") do
      val said = ran("torture --seeds 4 --duration 8s --workers 2", out)
      assert(clue(said).contains(found))
      assert(said.contains("4 of 4 flights of 8s, 0 failed"))
      for worker <- 1 to 2 do
        val isNeeded = found.startsWith("2")
        assertEquals(
          Files.deleteIfExists(out.resolve(s"worker-$worker.log")),
          isNeeded,
          s"worker $worker: $found"
        )

  private def files(folder: Path): Vector[Path] =
    Using.resource(Files.walk(folder))(_.iterator.asScala.filter(Files.isRegularFile(_)).toVector.sorted)

  for
    (name, words) <- Seq(
      "many flights"     -> "spread --loop stream --link vpn --duration 8s --seeds 2",
      "what was learned" ->
        ("learn --steps 2000 --environments 16 --lesson 5s --network 8 --episodes 2 --fresh 4 --flights 1 " +
          "--duration 12s --updates-per-step 0.02 --threads 1")
    )
  do
    test(s"$name: two processes write the result of a single one, to the bit, and every block counts once"):
      val (here, there) = (temporaryFolder(), temporaryFolder())
      ran(words, here): Unit
      val said    = ran(s"$words --workers 2", there)
      val written = files(here)
      assert(written.nonEmpty)
      for file <- written do
        val other = there.resolve(here.relativize(file))
        assert(Files.exists(other) && Files.mismatch(file, other) == -1, s"$other is another")
      val audit = Ledger.audit(there.resolve(Ledger.Name))
      assertEquals((audit.repeats, audit.broken), (0, 0L))
      assert(audit.blocks >= 2 && clue(said).contains(" blocks counted"))
