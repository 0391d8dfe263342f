package skein.port

import skein.units.Span

/** How AirSim executes moves of a vehicle, and how loops pace them. */
object Moves:
  /** Default maximum number of unanswered moves of one vehicle: the one in effect and the one that replaces
    * it. A third move that arrives during the replacement would wait for its end instead of its start.
    */
  final val InFlight = 2

  /** Largest allowed value of that setting, for flights and forward simulation: half of the commands that a
    * forecast stores.
    */
  final val MostInFlight = 32

  /** The reason why this number of unanswered moves is invalid; None if it is valid. */
  def mistake(inFlight: Int): Option[String] =
    Option.when(inFlight < 1 || inFlight > MostInFlight)(s"expected 1 to $MostInFlight, got $inFlight")

  /** Time from a move's cancellation to the start of its successor; measured at AirSim's server, below 0.3
    * ms.
    */
  val Handover: Span = Span.ofMillis(0.3)

  /** Pause of a loop after an answer, during which the handover finishes. */
  val HandoverAllowed: Span = Span.ofMillis(0.5)

  /** Default of the minimum interval between two moves of a loop. */
  val LeastInterval: Span = Span.ofMillis(20)
