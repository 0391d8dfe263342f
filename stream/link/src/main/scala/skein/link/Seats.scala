package skein.link

import java.util.concurrent.atomic.AtomicLong
import skein.units.{Clock, Instant, Span}

/** A port's [[Places]], shared by its connections, for protocols in which whoever is there speaks now and
  * then. From any thread.
  *
  * @param most connections at once
  */
private[skein] final class Seats(most: Int, private val clock: Clock):
  private val places             = Places(most, Seats.Silent)
  private val numbers            = AtomicLong()
  private val seated             = AtomicLong()
  private val displaced, refused = AtomicLong()

  /** Connections that gave up their place. */
  def displacedConnections: Long = displaced.get

  /** Connections for which there was no place. */
  def refusedConnections: Long = refused.get

  def taken: Int = seated.get.toInt

  /** A seat for one more connection, or none, where it is to be closed at once.
    *
    * @param leave closes it when another gets its place; called once at most, on that other's thread
    */
  def enter(leave: () => Unit): Option[Seats.Seat] =
    if places.admit() then
      val seat = Seats.Seat(this, numbers.incrementAndGet(), leave)
      seated.incrementAndGet(): Unit
      places.entered(seat.number, seat)
      Some(seat)
    else
      refused.incrementAndGet(): Unit
      None

private[skein] object Seats:
  /** A connection that has spoken may be silent for so long before another gets its place. */
  val Silent: Span = Span.ofSeconds(5)

  /** One connection's. */
  final class Seat private[Seats] (seats: Seats, private[Seats] val number: Long, close: () => Unit)
      extends Places.Guest:
    @volatile private var spokeAt = Option.empty[Instant]
    private val cameAt            = seats.clock.now()

    def hasSpoken: Boolean = spokeAt.isDefined
    def silentFor: Span    = seats.clock.now().since(spokeAt.getOrElse(cameAt))

    def leave(): Unit =
      seats.displaced.incrementAndGet(): Unit
      close()

    /** It has said something of use. */
    def spoke(): Unit = spokeAt = Some(seats.clock.now())

    /** Its connection has ended; to be called once. */
    def left(): Unit =
      seats.seated.decrementAndGet(): Unit
      seats.places.left(number)
