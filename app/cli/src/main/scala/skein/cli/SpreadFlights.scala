package skein.cli

import skein.flight.{NotFlown, VirtualFlights}
import skein.measure.FlightSummary
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings}

/** Runs many flights in virtual time and keeps their summaries. */
private[cli] object SpreadFlights:

  /** Runs the flights; prints progress on the error output. */
  def fly(settings: FlySettings, plans: Vector[FlightPlan])(using
      Scenarios
  ): Vector[Either[NotFlown, FlightSummary]] =
    val landed = SpreadProgress(plans.size)
    landed.tellingIfCut(summaries(settings, plans)(landed.one))

  /** Runs one flight on a thread of its own. Blocks. */
  def one(settings: FlySettings, plan: FlightPlan)(using Scenarios): Either[NotFlown, FlightSummary] =
    summaries(settings, Vector(plan))(()).head

  private def summaries(settings: FlySettings, plans: Vector[FlightPlan])(onLanded: => Unit)(using
      Scenarios
  ): Vector[Either[NotFlown, FlightSummary]] =
    VirtualFlights.summaries(settings, plans): summary =>
      onLanded
      summary

  /** Counts the flights that have ended, and prints the count from time to time. */
  final class SpreadProgress(of: Int, tell: String => Unit = Console.err.println(_)):
    @volatile private var landed = 0
    private def progress()       = s"$landed of $of flights have ended"

    /** Counts one more flight; the counts are printed in order even if flights end on several threads. */
    def one: Unit = synchronized:
      landed += 1
      if landed % (of / 20).max(1) == 0 then tell(progress())

    def tellingIfCut[A](body: => A): A = Edge.tellingIfCut(progress())(body)
