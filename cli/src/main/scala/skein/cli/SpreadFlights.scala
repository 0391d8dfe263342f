package skein.cli

import java.util.concurrent.atomic.AtomicInteger
import skein.flight.{NotFlown, VirtualFlights}
import skein.loop.Outcome
import skein.measure.FlightSummary
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings}

/** Many flights in virtual time, of which summaries are kept. */
private[cli] object SpreadFlights:

  /** Tells its progress on the error output. */
  def fly(settings: FlySettings, plans: Vector[FlightPlan])(using
      Scenarios
  ): Vector[Either[NotFlown, FlightSummary]] =
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
