package skein.link

import java.util.concurrent.atomic.AtomicLong
import skein.units.{Clock, Instant, Span}

/** A port's [[Places]], shared by its connections, for protocols in which every peer sends from time to time.
  * From any thread.
  *
  * @param most maximum number of open connections
  */
private[skein] final class Seats(most: Int, private val clock: Clock):
  private val places             = Places(most, Seats.Silent)
  private val numbers            = AtomicLong()
  private val displaced, refused = AtomicLong()

  /** Connections that lost their place to a new connection. */
  def displacedConnections: Long = displaced.get

  /** Connections that were refused for lack of a place. */
  def refusedConnections: Long = refused.get

  /** A seat for one more connection; None if it must be closed immediately.
    *
    * @param leave closes the connection when another gets its place; called at most once, on the other's
    *   thread
    */
  def enter(leave: () => Unit): Option[Seats.Seat] =
    if places.admit() then
      val seat = Seats.Seat(this, numbers.incrementAndGet(), leave)
      places.entered(seat.number, seat)
      Some(seat)
    else
      refused.incrementAndGet(): Unit
      None

private[skein] object Seats:
  /** Silence after which a connection may lose its place to a new connection. */
  val Silent: Span = Span.ofSeconds(5)

  /** One connection's seat, until it has `left`. */
  final class Seat private[Seats] (seats: Seats, private[link] val number: Long, close: () => Unit)
      extends Places.Guest:
    @volatile private var spokeAt = Option.empty[Instant]
    private val cameAt            = seats.clock.now()

    def hasSpoken: Boolean = spokeAt.isDefined
    def silentFor: Span    = seats.clock.now().since(spokeAt.getOrElse(cameAt))

    def leave(): Unit =
      seats.displaced.incrementAndGet(): Unit
      close()

    /** Records a valid message of the connection. */
    def spoke(): Unit = spokeAt = Some(seats.clock.now())

    /** Frees the seat of a closed connection; to be called once. */
    def left(): Unit =
      seats.places.left(number)
