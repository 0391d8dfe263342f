package skein.cli

import java.io.File
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import scala.collection.mutable.Buffer
import scala.concurrent.duration.*
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.cluster.WorkerProcesses
import skein.testing.{Lengthy, Optimised, TemporaryFolders}

/** A search of a program with a family of policies of its own, by a worker that was started as plain Skein:
  * three processes over loopback.
  */
class ShippedProgramLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Optimised:
  private lazy val parent = temporaryFolder()

  private val question =
    "search --family doubting --method random --candidates 64 --episodes 4 --fresh 16 --duration 12s"
      .split(' ')
      .toSeq

  /** The class path of a program that does not know this suite's classes. */
  private val plain = sys
    .props("java.class.path")
    .split(File.pathSeparatorChar)
    .filterNot(part => Files.exists(Path.of(part, "skein/cli/Doubters.class")))
    .mkString(File.pathSeparator)

  private def started(name: String, command: Seq[String]): Process =
    val builder = ProcessBuilder(command*).redirectErrorStream(true)
    builder.environment.put("XDG_CACHE_HOME", parent.resolve("cache").toString)
    builder.redirectOutput(parent.resolve(name).toFile).start()

  private def said(name: String): String = Files.readString(parent.resolve(name))

  private def worker(name: String, joins: String, more: String*): Process =
    val command =
      WorkerProcesses.likeThis("skein.cli.Main", Seq("worker", "--join", joins, "--threads", "1") ++ more)
    started(name, command.updated(command.indexOf("-cp") + 1, plain))

  test(
    "a plain worker fetches the program whose digest it was " +
      "given, and finds what one process finds, to the bit"
  ):
    val (out, alone) = (parent.resolve("found"), parent.resolve("alone"))
    val coordinator  = started(
      "coordinator.log",
      WorkerProcesses.likeThis(
        "skein.cli.Doubters",
        question ++ Seq("--cluster", "127.0.0.1:0", "--ship", "--out", out.toString)
      )
    )
    val processes = Buffer(coordinator)
    try
      val invitation = "--join (\\S+) --accept-jars ([0-9a-f]{64})".r
      def invited    = invitation.findFirstMatchIn(said("coordinator.log"))
      val deadline   = 2.minutes.fromNow
      while invited.isEmpty && coordinator.isAlive && deadline.hasTimeLeft() do Thread.sleep(20)
      val found              = invited.getOrElse(fail(said("coordinator.log")))
      val Seq(joins, digest) = found.subgroups: @unchecked
      val accepting          = worker("worker.log", joins, "--accept-jars", digest)
      processes += accepting
      val ran = Ran.of(Doubters.run(question ++ Seq("--out", alone.toString)))
      assertEquals(ran.status, 0, ran.said)
      def ended(process: Process, log: String) =
        assert(process.waitFor(4, TimeUnit.MINUTES), said("coordinator.log") + said(log))
        process.exitValue
      assertEquals(ended(coordinator, "worker.log"), 0, said("coordinator.log"))
      assertEquals(ended(accepting, "worker.log"), 0, said("worker.log"))
      assert(clue(said("worker.log")).contains("the work is done"))
      for name <- Seq("search.json", "policy.conf", "landscape.csv") do
        assertEquals(Files.mismatch(out.resolve(name), alone.resolve(name)), -1L, name)
      val kept = Using.resource(Files.list(parent.resolve("cache/skein/jars")))(_.toList.asScala.toVector)
      // The classes of this suite, and nothing of Skein's own.
      assertEquals(kept.count(_.toString.endsWith(".jar")), 1, kept.toString)
    finally processes.foreach(_.destroyForcibly(): Unit)
