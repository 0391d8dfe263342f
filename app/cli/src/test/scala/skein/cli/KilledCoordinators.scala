package skein.cli

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import scala.jdk.CollectionConverters.*
import scala.util.Random
import skein.blocks.Ledger
import skein.cluster.WorkerProcesses

/** A search with two workers, and one with five, whose coordinator is killed twice, and whose workers are
  * killed from time to time; each time it continues with `--resume`. Then its files are compared with those
  * of one process: `./sbtw "cli/Test/runMain skein.cli.killCoordinator 20000 1 20 5 DIR"`. Fails if they
  * differ, or if a block counts twice.
  *
  * @param candidates enough for the search to last for all kills
  * @param first the first run's number, which is its seed; likewise `last`
  * @param everyS time between kills of a worker, s; on a busy machine workers take long to start
  */
@main def killCoordinator(candidates: Int, first: Int, last: Int, everyS: Int, out: String): Unit =
  val question =
    ("search --family lead-pursuit --method random " +
      s"--candidates $candidates --episodes 10 --fresh 16 --duration 20s").split(' ').toSeq
  val alone  = Path.of(out).resolve("alone")
  val said   = ByteArrayOutputStream()
  val status =
    Console.withOut(said)(Console.withErr(said)(Main.run(question ++ Seq("--out", alone.toString))))
  require(status == 0, said.toString(UTF_8))

  for run <- first to last do
    val random                     = Random(run)
    val begun                      = System.nanoTime()
    val folder                     = Path.of(out).resolve(s"run-$run")
    val ledger                     = folder.resolve(Ledger.Name)
    def blocks                     = if Files.exists(ledger) then Ledger.audit(ledger).blocks else 0
    val count                      = if run % 2 == 1 then 2 else 5
    val elsewhere                  = Seq("--workers", s"$count", "--threads", s"$count", "--block", "1024")
    var (killed, workers, resumed) = (0, 0, 0)

    /** Runs a coordinator until it ends, or until the ledger has `until` more blocks, when it is killed. */
    def life(number: Int, until: Option[Int]): Unit =
      val words = if number == 0 then question ++ Seq("--out", folder.toString)
      else Seq("search", "--resume", folder.toString)
      val log         = Path.of(out).resolve(s"run-$run-$number.log")
      val before      = blocks
      val coordinator = ProcessBuilder(WorkerProcesses.likeThis("skein.cli.Main", words ++ elsewhere)*)
        .redirectErrorStream(true)
        .redirectOutput(log.toFile)
        .start()
      def children = coordinator.children().toList.asScala.filter(_.isAlive).toVector
      var next     = System.nanoTime() + everyS * 1_000_000_000L
      while coordinator.isAlive && until.forall(more => blocks < before + more) do
        coordinator.waitFor(50, TimeUnit.MILLISECONDS): Unit
        if System.nanoTime() > next then
          next = System.nanoTime() + everyS * 1_000_000_000L
          val alive = children
          if alive.nonEmpty then
            alive(random.nextInt(alive.size)).destroyForcibly(): Unit
            workers += 1
      val left = children
      if coordinator.isAlive then
        coordinator.destroyForcibly().waitFor(): Unit
        killed += 1
      else require(coordinator.exitValue == 0, Files.readString(log))
      // They end with their coordinator.
      left.foreach(_.onExit().get(60, TimeUnit.SECONDS))
      "(\\d+) more were in the ledger".r
        .findFirstMatchIn(Files.readString(log))
        .foreach(found => resumed += found.group(1).toInt)

    life(0, Some(5 + random.nextInt(20)))
    life(1, Some(5 + random.nextInt(20)))
    life(2, None)
    require(killed == 2, s"$killed coordinators were killed: more candidates let it last longer")
    for name <- Seq("search.json", "policy.conf", "landscape.csv") do
      require(Files.mismatch(folder.resolve(name), alone.resolve(name)) == -1, s"$name of run $run differs")
    val audit = Ledger.audit(ledger)
    require(audit.repeats == 0 && audit.broken == 0, audit.toString)
    println(
      f"run $run: $count workers, of whom $workers were killed, coordinator killed $killed " +
        f"times; the same files to the bit; ${audit.blocks} blocks, each counted once; the last " +
        f"life found $resumed in the ledger; ${(System.nanoTime() - begun) * 1e-9}%.0f s"
    )
