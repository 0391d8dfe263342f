package skein.cli

import java.nio.file.Path
import mainargs.{Flag, ParserForClass, arg}
import skein.flight.{NotFlown, VirtualFlights}
import skein.measure.FlightSummary
import skein.report.{Report, ReportSections, Section}
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.units.Expect

/** Command-line options of `./skein spread`, with their help texts. */
final case class SpreadOptions(
    flights: FlightOptions,
    @arg(doc = "how many times each flight is flown, each time with another seed")
    seeds: Int = 100,
    cluster: ClusterOptions,
    @arg(doc =
      "folder for spread.html and its pictures, and for what workers computed: the " +
        "same command with the same folder goes on where it was stopped; without it, " +
        "only the tables are shown (with workers: spread/DATE-TIME)"
    )
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** @param program the class whose `main` starts the commands
  */
final class SpreadCommand(program: String)(using Scenarios)
    extends Command[SpreadOptions](
      "spread",
      "flies each loop over each link many times in virtual time, and shows mean and spread",
      ParserForClass[SpreadOptions]
    ):

  override protected def defaults: Map[String, String]   = FlightOptions.defaults
  override protected def known: Map[String, Seq[String]] = FlightOptions.known

  override protected def refusedAlways: Set[String] = Set("only", "images")

  override protected def check(options: SpreadOptions): Either[String, Unit] =
    options.flights.settings.map(_ => ())

  protected def execute(options: SpreadOptions): Either[String, Unit] =
    for
      settings <- options.flights.settings
      _        <- SolverOptions.virtual(settings)
      _        <- VirtualFlights.tooLong(settings).map("--" + _).toLeft(())
      _        <- Expect.that(settings.only.isEmpty)("--only: expected with fly alone")
      _        <- Expect.that(settings.images.isEmpty):
        "--images: expected with fly alone; spread keeps no recordings"
      _       <- Expect.within("--seeds", options.seeds, 1, SpreadCommand.MostSeeds)
      cluster <- options.cluster.checked
      _       <- Expect.that(cluster.flatMap(_.block).forall(_ == 1)):
        "--block: expected 1, since each flight is a block of its " +
          s"own, got ${options.cluster.block.getOrElse(0)}"
      named = options.out.orElse(cluster.map(_ => OutFolder.dated("spread")))
      out <- Expect.optional(named)(OutFolder.made("--out", _))
      ready = SpreadQuestion.Ready(settings)
      plans = ready.flights(options.seeds)
      shown = Shown(options.json.value)
      landed <- cluster.zip(out) match
        case None                  => Right(SpreadFlights.fly(settings, plans))
        case Some((asked, folder)) => elsewhere(options, settings, ready, asked, folder, shown)
      (missing, flown) = landed.partitionMap(identity)
      sections         = ReportSections.spread(flown)
      _                = shown.tables(sections, Section.text(sections))
      _ <- out.fold(Right(()))(folder =>
        Report
          .writeSpread(flown, folder)
          .map(output => shown.say(s"spread in ${output.page}"))
      )
      failures = sections.flatMap(_.failure)
      _ <- Expect.that(failures.isEmpty)(failures.mkString("\n"))
      _ <- Expect.that(missing.isEmpty)(NotFlown.message(missing, plans.size))
    yield ()

  private def elsewhere(
      options: SpreadOptions,
      settings: FlySettings,
      ready: SpreadQuestion.Ready,
      asked: ClusterOptions.Checked,
      folder: Path,
      shown: Shown
  ): Either[String, Vector[Either[NotFlown, FlightSummary]]] =
    val flights = ready.flights(options.seeds).size
    val landed  = SpreadFlights.SpreadProgress(flights, tell = _ => ())
    for
      config   <- options.flights.configuration
      question <- SpreadQuestion.of(config, settings)
      flown    <- OutFolder.alone(folder):
        ClusterRun.using(
          asked,
          program,
          QuestionKind.Spread.of(question.bytes),
          folder,
          Runtime.getRuntime.availableProcessors,
          shown
        ): run =>
          val line = ProgressLine(flights, Console.err)
          landed.tellingIfCut:
            val all = ready.elsewhere(run, options.seeds, shown.say)(landed.one)(
              line.show((flights * run.share).toLong, run.status)
            )
            line.end()
            all
    yield flown

private object SpreadCommand:
  /** Maximum number of flights: their summaries are kept until the last has ended, about 40 kB for each
    * vehicle and minute.
    */
  private val MostSeeds = 100_000
