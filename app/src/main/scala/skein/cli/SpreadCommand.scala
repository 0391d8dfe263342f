package skein.cli

import java.util.concurrent.atomic.AtomicInteger
import mainargs.{ParserForClass, arg}
import skein.experiment.VirtualFlights
import skein.report.{FlightSummary, SpreadTable, TeamFlights, TeamTables}

/** Options of `./skein spread`. */
final case class SpreadOptions(
    flights: FlightOptions,
    @arg(doc = "how many times each flight is flown, each time with another seed")
    seeds: Int = 100
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
      landed = AtomicInteger()
      flown <- VirtualFlights.inParallel(settings, plans): flight =>
        val count = landed.incrementAndGet()
        if count % (plans.size / 20).max(1) == 0 then
          Console.err.println(s"$count of ${plans.size} flights have landed")
        FlightSummary.of(flight.recorder.recording)
      duels = flown.filter(_.team.isEmpty)
      teams = TeamFlights.of(flown)
    yield
      if duels.nonEmpty then Console.out.println(SpreadTable.of(duels).render)
      teams.foreach(flights => Console.out.println(TeamTables.spread(flights).render))
