package skein.cli

import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.kafka.KafkaBroker
import skein.link.Address
import skein.measure.{Distribution, FlightSummary}
import skein.record.RecordingReader
import skein.scenario.Scenarios

/** The increase in age at decisions by a solver in another process, by TCP and by Kafka on loopback:
  * `./sbtw cli/stage "cli/Test/runMain skein.cli.solverHops 40 3 vpn DIR"`. For each a solver is started and
  * then used by flights one after the other, so that the first one shows a cold start. Each runs `predictive`
  * without the hop and with it.
  *
  * @param seconds duration of each flight
  * @param flights number of flights of each solver
  * @param out folder for recordings and logs, which must not exist yet
  */
@main def solverHops(seconds: Int, flights: Int, link: String, out: String): Unit =
  given Scenarios = Scenarios.ours
  val launcher    = Iterator
    .iterate(Path.of("").toAbsolutePath)(_.getParent)
    .map(_.resolve("app/cli/target/universal/stage/bin/skein"))
    .find(Files.exists(_))
    .getOrElse(throw IllegalStateException("expected a launcher, made by ./sbtw cli/stage"))
  val folder = Files.createDirectory(Path.of(out)).toAbsolutePath

  def started(log: Path, words: String*): Process =
    ProcessBuilder((launcher.toString +: words)*).redirectErrorStream(true).redirectOutput(log.toFile).start()

  def said(log: Path) = Files.readString(log)

  def spread(of: Option[Distribution]) =
    of.fold("none")(ms => f"p50 ${ms.median}%.1f ms, p99 ${ms.p99}%.1f ms")

  def told(file: Path): String =
    val recording =
      RecordingReader.read(file).fold(error => throw IllegalStateException(error.message), identity)
    val summary  = FlightSummary.of(recording)
    val headline = summary.headline.fold("none")(metres => f"$metres%.2f")
    val hop      = summary.solver.fold("decided here"): solver =>
      s"${solver.answers} answers, added ${spread(solver.roundTripsMs)}, ${solver.missed} missed"
    s"${summary.name}: $hop; age at command ${spread(summary.commandAgesMs)}; result $headline"

  val broker =
    KafkaBroker.start(folder.resolve("broker"), Address("127.0.0.1", 9092)).fold(sys.error, identity)
  for (kind, at) <- Seq("tcp" -> "tcp://127.0.0.1:7400", "kafka" -> s"kafka://${broker.address}/skein") do
    val log    = folder.resolve(s"$kind-decide.log")
    val solver = started(log, "decide", "--at", at)
    try
      while solver.isAlive && !said(log).contains("decides at") do Thread.sleep(50)
      for number <- 1 to flights do
        val flown = folder.resolve(s"$kind-$number")
        val words =
          s"fly --loop predictive --link $link --duration ${seconds}s --twins 0 --solver $at --out $flown"
        val own    = folder.resolve(s"$kind-$number.log")
        val flight = started(own, words.split(' ').toSeq*)
        try require(flight.waitFor() == 0, s"$words: ${said(own)}")
        finally flight.destroyForcibly(): Unit
        val recordings =
          Using.resource(
            Files.list(flown)
          )(_.iterator.asScala.filter(_.toString.endsWith(".duckdb")).toVector.sorted)
        for file <- recordings do println(s"$kind, flight $number: ${told(file)}")
    finally
      solver.destroy()
      if !solver.waitFor(30, TimeUnit.SECONDS) then solver.destroyForcibly(): Unit
  broker.close()
