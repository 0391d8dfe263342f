package skein.cli

import java.util.concurrent.atomic.AtomicInteger
import mainargs.{Flag, ParserForClass, arg}
import skein.flight.{NotFlown, VirtualFlights}
import skein.loop.Outcome
import skein.measure.FlightSummary
import skein.report.{Report, ReportSections, Section}
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings}

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

  protected def execute(options: SpreadOptions): Either[String, Unit] =
    for
      settings <- options.flights.settings
      _        <- Either.cond(options.seeds > 0, (), s"--seeds: expected 1 or more, came ${options.seeds}")
      out      <- options.out.fold(Right(None))(OutFolder.made("--out", _).map(Some(_)))
      plans =
        for plan <- settings.plans; number <- 0 until options.seeds
        yield plan.copy(seed = settings.seed + number)
      (missing, flown) = fly(settings, plans).partitionMap(identity)
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

  private def fly(settings: FlySettings, plans: Vector[FlightPlan]): Vector[Either[NotFlown, FlightSummary]] =
    val landed     = AtomicInteger()
    def progress() = s"${landed.get} of ${plans.size} flights have landed"
    Edge.tellingIfCut(progress()):
      VirtualFlights
        .inParallel(settings, plans): flight =>
          val summary = flight.landed.outcome match
            case Outcome.Failed(reason) => Left(NotFlown(flight.landed.plan, reason))
            case _                      => Right(FlightSummary.of(flight.recorder.recording))
          if landed.incrementAndGet() % (plans.size / 20).max(1) == 0 then Console.err.println(progress())
          summary
        .map(_.flatten)
