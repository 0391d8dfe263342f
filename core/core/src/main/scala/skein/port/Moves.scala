package skein.port

import skein.units.Span

/** How AirSim executes moves of a vehicle, and how loops pace them. */
object Moves:
  /** Limit of unanswered moves of one vehicle, unless configured: the one in effect and the one that replaces
    * it. A third one that arrives during the replacement waits for its end, not its start.
    */
  final val InFlight = 2

  /** The greatest limit that may be configured, for flights and forward simulation: half of the commands that
    * a forecast keeps.
    */
  final val MostInFlight = 32

  /** Why this number of moves in flight is invalid, if it is. */
  def mistake(inFlight: Int): Option[String] =
    Option.when(inFlight < 1 || inFlight > MostInFlight)(s"expected 1 to $MostInFlight, came $inFlight")

  /** From a move's cancellation to the start of its successor, measured at AirSim's server: below 0.3 ms. */
  val Handover: Span = Span.ofMillis(0.3)

  /** Pause after an answer in which a loop lets the handover finish. */
  val HandoverAllowed: Span = Span.ofMillis(0.5)

  /** Interval between two moves of a loop, unless configured. */
  val LeastInterval: Span = Span.ofMillis(20)
