package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import skein.flight.NotFlown
import skein.report.{Report, ReportSections, Section}
import skein.scenario.Scenarios

/** Options of `./skein spread`. */
final case class SpreadOptions(
    flights: FlightOptions,
    @arg(doc = "how many times each flight is flown, each time with another seed")
    seeds: Int = 100,
    @arg(doc = "folder for spread.html and its pictures; without it, only the tables are shown")
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

final class SpreadCommand(using Scenarios)
    extends OptionsCommand[SpreadOptions](
      "spread",
      "flies each loop over each link many times in virtual time, and shows mean and spread",
      ParserForClass[SpreadOptions]
    ):

  override protected def defaults: Map[String, String] = FlightOptions.defaults

  protected def execute(options: SpreadOptions): Either[String, Unit] =
    for
      settings <- options.flights.settings
      _        <- SolverOptions.virtual(settings)
      _        <- Either.cond(
        settings.images.isEmpty,
        (),
        "--images: expected with fly alone; spread keeps no recordings"
      )
      _   <- Either.cond(options.seeds > 0, (), s"--seeds: expected 1 or more, came ${options.seeds}")
      out <- options.out.fold(Right(None))(OutFolder.made("--out", _).map(Some(_)))
      plans =
        for plan <- settings.plans; number <- 0 until options.seeds
        yield plan.copy(seed = settings.seed + number)
      (missing, flown) = SpreadFlights.fly(settings, plans).partitionMap(identity)
      shown            = Shown(options.json.value)
      sections         = ReportSections.spread(flown)
      _                = shown.tables(sections, Section.text(sections))
      _ <- out.fold(Right(()))(folder =>
        Report
          .writeSpread(flown, folder)
          .map(output => shown.say(s"spread in ${output.page}"))
      )
      _ <- Either.cond(missing.isEmpty, (), NotFlown.message(missing, plans.size))
    yield ()
