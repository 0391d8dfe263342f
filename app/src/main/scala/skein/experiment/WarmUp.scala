package skein.experiment

import scala.annotation.tailrec
import skein.link.Clock
import skein.units.*

/** Flies what is to be flown live in virtual time first, so that the compiler has seen the whole way of a decision
  * before the first one counts. At ten decisions a second a flight of a minute would end before it is compiled: cold, a
  * decision takes two to three times as long from the reading to the command (`skein.bench.FrameworkLatency`).
  */
object WarmUp:
  /** How many flights it takes: with twenty, a duel's decisions are as quick from the first one on as they get. */
  val Flights = 20

  /** After which it is enough, of real time, for large teams and for loops that plan. */
  val AtMost: Span = Span.ofSeconds(6)

  /** Of each flight: short, so that every loop and link has its turn. */
  private val Flown = Span.ofSeconds(5)

  /** Flies the plans of `settings` in turn; blocks.
    *
    * @param flights
    *   after which it ends, or with the first flight that ends later than [[AtMost]]
    * @return
    *   how many were flown, or why one could not be
    */
  def fly(settings: FlySettings, flights: Int, clock: Clock): Either[String, Int] =
    val short = settings.copy(duration = settings.duration.min(Flown))
    val plans = short.plans
    val until = clock.now() + AtMost

    @tailrec
    def next(flown: Int): Either[String, Int] =
      if flown == flights || clock.now() >= until then Right(flown)
      else
        val plan = plans(flown % plans.size)
        VirtualFlights.fly(short, plan) match
          case Right(_)     => next(flown + 1)
          case Left(reason) => Left(s"${plan.id}, to warm up: $reason")

    next(0)
