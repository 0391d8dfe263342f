package skein.cli

import java.net.ServerSocket
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future, blocking}
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*
import scala.util.Using
import skein.blocks.Ledger
import skein.cluster.WorkerProcesses
import skein.testing.{Lengthy, Optimised, TemporaryFolders}

/** Searches by processes of this machine, over loopback. */
class ClusterCommandsLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Optimised:
  private given ExecutionContext = ExecutionContext.global

  private val question =
    "search --family paper-pursuer --method random --candidates 1000 --episodes 10 --fresh 16 --duration 20s"
      .split(' ')
      .toSeq

  /** Options for blocks large enough that a search can be interrupted between them. */
  private def elsewhere(workers: Int) = Seq("--workers", workers.toString, "--block", "256")

  private lazy val parent          = temporaryFolder()
  private def folder(name: String) = parent.resolve(name)

  /** The result of a search in this process only. */
  private lazy val alone: Path =
    searched(question ++ Seq("--out", folder("alone").toString))
    folder("alone")

  private def searched(words: Seq[String]): String =
    val ran = Ran.of(Main.run(words))
    assertEquals(ran.status, 0, ran.said)
    ran.said

  private def assertSame(found: Path): Unit =
    for name <- Seq("search.json", "policy.conf", "landscape.csv") do
      assertEquals(Files.readString(found.resolve(name)), Files.readString(alone.resolve(name)), name)
    val audit = Ledger.audit(found.resolve(Ledger.Name))
    assertEquals((audit.repeats, audit.broken), (0, 0L))
    assert(audit.blocks > 40, audit.toString)

  private def log(folder: Path, worker: Int): String =
    val file = folder.resolve(s"worker-$worker.log")
    if Files.exists(file) then Files.readString(file) else ""

  /** Polls a condition that other processes bring about. */
  private def until(isSo: => Boolean)(unless: => Boolean): Boolean =
    val deadline = 4.minutes.fromNow
    while !isSo && !unless && deadline.hasTimeLeft() do Thread.sleep(20)
    isSo

  test(
    "a search that survives the loss of its coordinator and a worker equals that of one process, to the bit"
  ):
    val out     = folder("resumed")
    val command =
      WorkerProcesses.likeThis("skein.cli.Main", question ++ elsewhere(1) ++ Seq("--out", out.toString))
    val coordinator = ProcessBuilder(command*)
      .redirectErrorStream(true)
      .redirectOutput(Files.createTempFile(parent, "coordinator", ".log").toFile)
      .start()
    // In parallel, since other processes are slow to start.
    val expected = Future(blocking(alone))
    def blocks   =
      if Files.exists(out.resolve(Ledger.Name)) then Ledger.audit(out.resolve(Ledger.Name)).blocks else 0
    assert(until(blocks >= 4)(!coordinator.isAlive))
    val workers = coordinator.children().toList.asScala
    coordinator.destroyForcibly().waitFor(): Unit
    for worker <- workers do
      worker.onExit().get(60, TimeUnit.SECONDS): Unit
    Files.delete(out.resolve("worker-1.log"))

    val searching = Future(blocking(searched(Seq("search", "--resume", out.toString) ++ elsewhere(1))))
    val atWork    = until(log(out, 1).contains("computes its first block"))(searching.isCompleted)
    assert(atWork, log(out, 1))
    val pid = """(\d+), \d+ cores?, build""".r.findFirstMatchIn(log(out, 1)).get.group(1).toLong
    assert(ProcessHandle.of(pid).toScala.exists(_.destroyForcibly()))
    val said = Await.result(searching, 8.minutes)
    assert(clue(said).contains(s"-$pid is gone"))
    val had = """(\d+) more were in the ledger""".r.findFirstMatchIn(said).get.group(1).toInt
    // Blocks of the current round; those before it are in the search's own state.
    assert(clue(had) > 0)
    Await.result(expected, 8.minutes): Unit
    assertSame(out)
    assert(
      ProcessHandle.current().children().toList.asScala.forall(
        !_.info().commandLine().toScala.exists(_.contains("skein.cli.Main worker"))
      ),
      "a worker outlived its search"
    )

  test("workers with vectors of 8 and of 16 lanes find the result of one process, to the bit"):
    val at      = s"127.0.0.1:${Using.resource(ServerSocket(0))(_.getLocalPort)}"
    val out     = folder("lanes")
    val workers = Seq(32, 64).map: bytes =>
      val words = Seq("worker", "--join", at, "--threads", "1", "--patience", "4min")
      val java  = WorkerProcesses.likeThis("skein.cli.Main", words)
      val told  = Files.createTempFile(parent, s"lanes-$bytes", ".log")
      val own   = ProcessBuilder((java.head +: s"-XX:MaxVectorSize=$bytes" +: java.tail)*)
      (own.redirectErrorStream(true).redirectOutput(told.toFile).start(), told)
    try
      for (worker, told) <- workers do
        assert(until(Files.readString(told).contains(": joining"))(!worker.isAlive), Files.readString(told))
      // If no worker works, the search waits for others.
      val words = question ++ Seq("--cluster", at, "--block", "256", "--out", out.toString)
      val said  = Await.result(Future(blocking(searched(words))), 4.minutes)
      for (worker, _) <- workers do
        val counted = s"-${worker.pid} +1 +(\\d+)".r.findFirstMatchIn(said).fold(0)(_.group(1).toInt)
        assert(counted > 0, said)
        assertEquals(worker.waitFor(), 0)
      assertSame(out)
    finally workers.foreach(_._1.destroyForcibly(): Unit)

  test("options that need workers, and workers that cannot start, are reported"):
    def refused(words: String*): String =
      val ran = Ran.of(Main.run(question ++ words ++ Seq("--out", folder("refused").toString)))
      assertEquals(ran.status, 1)
      ran.err
    assert(clue(refused("--block", "7")).contains("--workers"))
    assert(clue(refused("--workers", "0")).contains("expected 1 to"))
    assert(clue(refused("--cluster", "0.0.0.0:0")).contains("certificates"))
