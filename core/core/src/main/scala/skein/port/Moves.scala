package skein.port

import skein.units.Span

/** How AirSim takes moves of a vehicle, and how loops keep to it. */
object Moves:
  /** Unanswered moves of one vehicle, unless set otherwise: the one that flies and the one that replaces it.
    * A third that comes while one replaces the other waits for its end, not its begin.
    */
  final val InFlight = 2

  /** As many may be set, for flights and for forward simulation: half of what a forecast remembers. */
  final val MostInFlight = 32

  /** What is wrong with this number of moves in flight, if anything is. */
  def mistake(inFlight: Int): Option[String] =
    Option.when(inFlight < 1 || inFlight > MostInFlight)(s"expected 1 to $MostInFlight, came $inFlight")

  /** From a move's cancellation to its successor's begin, measured at AirSim's server: below 0.3 ms. */
  val Handover: Span = Span.ofMillis(0.3)

  /** What a loop leaves for that after an answer. */
  val HandoverAllowed: Span = Span.ofMillis(0.5)

  /** Between two moves of a loop that is told nothing else. */
  val LeastInterval: Span = Span.ofMillis(20)
