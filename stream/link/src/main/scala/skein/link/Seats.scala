package skein.link

import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import skein.units.Clock

/** A port's [[Places]], shared by its connections. From any thread.
  *
  * @param most connections at once
  */
final class Seats(most: Int, private val clock: Clock):
  private val places             = AtomicReference(Places.of[Seats.Seat](most))
  private val displaced, refused = AtomicLong()

  /** Connections that gave up their place. */
  def displacedConnections: Long = displaced.get

  /** Connections for which there was no place. */
  def refusedConnections: Long = refused.get

  def taken: Int = places.get.guests.size

  /** A seat for one more connection, or none, where it is to be closed at once.
    *
    * @param leave closes it when another gets its place; called once at most, on that other's thread
    */
  def enter(leave: () => Unit): Option[Seats.Seat] =
    val seat                        = Seats.Seat(this, leave)
    def enter(): Option[Seats.Seat] =
      val before = places.get
      before.entered(seat, clock.now()) match
        case Places.Entry.Full() =>
          refused.incrementAndGet(): Unit
          None
        case Places.Entry.Free(after) => if places.compareAndSet(before, after) then Some(seat) else enter()
        case Places.Entry.InPlaceOf(other, after) =>
          if !places.compareAndSet(before, after) then enter()
          else
            displaced.incrementAndGet(): Unit
            other.leave()
            Some(seat)
    enter()

object Seats:
  /** One connection's. */
  final class Seat private[Seats] (seats: Seats, private[Seats] val leave: () => Unit):
    /** It has said something of use. */
    def spoke(): Unit =
      val now = seats.clock.now()
      seats.places.updateAndGet(_.spoke(this, now)): Unit

    /** Its connection has ended. */
    def left(): Unit = seats.places.updateAndGet(_.left(this)): Unit
