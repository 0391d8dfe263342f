package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.{AirSimClient, Collision, VehicleClient}
import skein.record.{Event, EventKind, Recorder}
import skein.units.*
import skein.units.Decimals.fixed

/** Requests each vehicle's contacts from the simulator once a period, and records them. It uses a separate
  * connection without the link, since this is not part of the flight.
  */
private[flight] final class ContactWatch(
    client: AirSimClient,
    watched: Vector[VehicleClient],
    period: Span,
    clock: Clock,
    recorder: Recorder
)(using system: ActorSystem):
  import ContactWatch.*
  import system.dispatcher

  private val vehicles         = watched.map(_.over(client))
  @volatile private var closed = false
  private var last             = vehicles.map(_ => Option.empty[Collision])

  /** Starts the watch; contacts before its start do not count. */
  def start(): Future[Unit] = ask().map(_ => goOn())

  private def ask(): Future[Vector[Option[Collision]]] =
    Future.traverse(vehicles): vehicle =>
      vehicle.collision().map:
        case Right(contact) => contact
        case Left(error)    =>
          recorder.offer(
            Event(clock.now(), EventKind.TimedOut, Some(vehicle.name), s"contacts: ${error.message}")
          )
          None

  private def note(touched: Vector[Option[Collision]]): Unit = synchronized:
    for (vehicle, index) <- vehicles.zipWithIndex; contact <- touched(index) do
      if isNew(contact, last(index)) then
        recorder.offer(Event(clock.now(), EventKind.Contact, Some(vehicle.name), told(contact)))
      last = last.updated(index, Some(contact))

  private def goOn(): Unit = if !closed then
    val _ = system.scheduler.scheduleOnce(period.toDuration)(ask().foreach: touched =>
      note(touched)
      goOn())

  def close(): Future[Done] =
    closed = true
    ask().map(note).transformWith(_ => client.close())

private[flight] object ContactWatch:

  /** Contacts with an object within this time of each other count as one. */
  val Within: Span = Span.ofMillis(500)

  def isNew(contact: Collision, before: Option[Collision]): Boolean =
    !before.exists(last =>
      last.objectName == contact.objectName && contact.at.since(last.at) <= Within
    )

  private def told(contact: Collision): String =
    val at = contact.positionNed
    s"${contact.objectName}, at ${at.x.fixed(1)} m north, ${at.y.fixed(1)} m east, ${(-at.z).fixed(1)} m up"
