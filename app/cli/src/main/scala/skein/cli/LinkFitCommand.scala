package skein.cli

import java.nio.file.{Files, Path}
import mainargs.{Leftover, ParserForClass, arg}
import skein.measure.{LinkFit, RoundTripTrace}
import skein.record.RecordingReader
import skein.settings.TextFile
import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.units.Decimals.significant
import skein.units.Expect

/** Command-line options of `./skein link-fit`, with their help texts. */
final case class LinkFitOptions(
    @arg(doc =
      "a recording, the output of ping, or lines time_s,rtt_ms, with nothing after the comma where no answer came"
    )
    file: Leftover[String],
    @arg(doc = "folder for round-trips.txt, which the profile names")
    out: String = "link"
)

/** `./skein link-fit`: fits a link's profile to measured round trips. */
object LinkFitCommand
    extends Command[LinkFitOptions](
      "link-fit",
      "fits a link's profile to a recording, to ping's output or to a table, for --link",
      ParserForClass[LinkFitOptions]
    ):

  private val MostQuantiles = 1000
  private val Measured      = "round-trips.txt"

  protected def execute(options: LinkFitOptions): Either[String, Unit] =
    for
      file   <- only(options.file, "file", "./skein link-fit FILE")
      traces <- read(file)
      trips = traces.flatMap(_.answered)
      fit   = LinkFit.of(traces)
      text  = fit.text(s"file:${Path.of(options.out).resolve(Measured)}")
      _      <- LatencyProfile.parse(text, _ => Right("1")).left.map(_.message)
      folder <- OutFolder.made("--out", options.out)
      _      <- unchanged(folder.resolve(Measured), written(file, trips))
      _      <- OutFolder.write(folder, Seq(OutFolder.text(Measured, written(file, trips))))
    yield say(fit, text)

  /** Refuses to change the round trips that an earlier profile names. */
  private def unchanged(measured: Path, text: String): Either[String, Unit] =
    Expect.that(!Files.exists(measured) || TextFile.read(measured.toString) == Right(text)):
      s"--out: $measured holds other round trips, which their profile names: expected another folder"

  private def read(file: String): Either[String, Vector[RoundTripTrace]] =
    if Seq(".duckdb", ".mcap").exists(file.endsWith) then
      for
        recording <- RecordingReader.read(Path.of(file)).left.map(_.message)
        _         <- Expect.that(recording.readings.nonEmpty)(s"$file: expected readings, got none")
      yield RoundTripTrace.of(recording)
    else TextFile.read(file).flatMap(RoundTripTrace.parse(_).left.map(s"$file: " + _)).map(Vector(_))

  /** Round trips, one line each: those measured, or quantiles of them. */
  private def written(file: String, trips: Vector[Double]): String =
    val shown =
      if trips.sizeIs <= MostQuantiles then trips
      else
        val all = LatencyDistribution.ofSamples(trips)
        Vector.tabulate(MostQuantiles)(i => all.quantile(i / (MostQuantiles - 1.0)).toMillis)
    shown.map(_.significant(6)).mkString(s"# round trips in ms, of $file\n", "\n", "\n")

  private def say(fit: LinkFit, text: String): Unit =
    val bursts = fit.burst.fold("in no bursts")(length => s"in bursts of ${length.significant(3)} on average")
    val lost   =
      if fit.lossShare == 0 then "none lost" else s"${(fit.lossShare * 100).significant(3)} % lost, $bursts"
    val held = fit.correlatedS.fold(
      "successive round trips are independent; a profile draws the two directions independently, so " +
        "its round trips spread less"
    )(s => s"a round trip lasts for ${s.significant(3)} s")
    Console.err.println(s"${fit.samples} requests, $lost; $held")
    Console.err.println(
      s"log-normal, its distribution function within ${fit.distance.significant(2)} of the measured one: ${fit.logNormalText}"
    )
    Console.out.println(text)
