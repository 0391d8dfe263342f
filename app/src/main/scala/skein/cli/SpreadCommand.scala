package skein.cli

import java.nio.file.Path
import java.util.concurrent.atomic.AtomicInteger
import mainargs.{ParserForClass, arg}
import skein.experiment.{FlightPlan, FlySettings, NotFlown, VirtualFlights}
import skein.loop.Outcome
import skein.report.{FlightSummary, PredictionGroup, Report, SpreadTable, TeamFlights, TeamTables}

/** Options of `./skein spread`. */
final case class SpreadOptions(
    flights: FlightOptions,
    @arg(doc = "how many times each flight is flown, each time with another seed")
    seeds: Int = 100,
    @arg(doc = "folder for spread.html and its pictures; without it, only the tables are shown")
    out: Option[String]
)

object SpreadCommand
    extends OptionsCommand[SpreadOptions](
      "spread",
      "flies each loop over each link many times in virtual time, and shows mean and spread",
      ParserForClass[SpreadOptions]
    ):

  protected def execute(options: SpreadOptions): Either[String, Unit] =
    for
      settings <- options.flights.settings
      _        <- Either.cond(options.seeds > 0, (), s"--seeds: expected 1 or more, came ${options.seeds}")
      plans =
        for plan <- settings.plans; number <- 0 until options.seeds
        yield plan.copy(seed = settings.seed + number)
      (missing, flown) = fly(settings, plans).partitionMap(identity)
      duels            = flown.filter(_.team.isEmpty)
      tables           =
        Option.when(duels.nonEmpty)(SpreadTable.of(duels)).toVector ++ TeamFlights.of(
          flown
        ).map(TeamTables.spread)
      predictions = PredictionGroup.of(flown)
      _           = (tables ++ Option.when(predictions.nonEmpty)(PredictionGroup.table(predictions)))
        .foreach(table => Console.out.println(table.render + "\n"))
      _ <- options.out.fold(Right(()))(folder =>
        Report
          .writeSpread(flown, tables, Path.of(folder))
          .map(output => Console.out.println(s"spread in ${output.page}"))
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
