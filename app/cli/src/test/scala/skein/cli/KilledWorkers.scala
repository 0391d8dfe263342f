package skein.cli

import java.nio.file.{Files, Path}
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future, blocking}
import scala.jdk.CollectionConverters.*
import scala.util.Random
import skein.blocks.Ledger

/** A search with three workers, one of which is killed every 5 s; then an equal search in this process only:
  * `./sbtw "cli/Test/runMain skein.cli.killWorkers 60000 20 DIR"`. Fails if their files differ, or if a block
  * counts twice.
  *
  * @param candidates enough for the search to last for all kills
  */
@main def killWorkers(candidates: Int, kills: Int, out: String): Unit =
  given ExecutionContext = ExecutionContext.global
  val question           =
    ("search --family lead-pursuit --method random " +
      s"--candidates $candidates --episodes 10 --fresh 16 --duration 20s").split(' ').toSeq
  val Seq(together, alone)           = Seq("together", "alone").map(Path.of(out).resolve(_))
  def search(words: String*): String =
    val ran = Ran.of(Main.run(question ++ words))
    require(ran.status == 0, ran.said)
    ran.said

  val random    = Random(1)
  val searching =
    Future(blocking(search(
      "--workers",
      "3",
      "--threads",
      "3",
      "--block",
      "2048",
      "--out",
      together.toString
    )))
  var killed = 0
  while killed < kills && !searching.isCompleted do
    Thread.sleep(5000)
    val workers = ProcessHandle.current().children().toList.asScala.filter(_.isAlive)
    if workers.nonEmpty && !searching.isCompleted then
      workers(random.nextInt(workers.size)).destroyForcibly(): Unit
      killed += 1
  val said = Await.result(searching, 1.hour)
  search("--out", alone.toString): Unit

  println(said.linesIterator.filter(line =>
    line.contains("blocks counted") || line.contains("is gone")
  ).mkString("\n"))
  for name <- Seq("search.json", "policy.conf", "landscape.csv") do
    require(Files.mismatch(together.resolve(name), alone.resolve(name)) == -1, s"$name differs")
  val audit = Ledger.audit(together.resolve(Ledger.Name))
  require(audit.repeats == 0 && audit.broken == 0, audit.toString)
  println(s"$killed workers killed; the same files to the bit; ${audit.blocks} blocks, each counted once")
