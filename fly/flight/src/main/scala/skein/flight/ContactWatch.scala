package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.{AirSimClient, Collision, VehicleClient}
import skein.record.{Event, EventKind, Recorder}
import skein.units.*
import skein.units.Decimals.fixed

/** Asks the simulator once a period what each vehicle has touched, and records it. It has a connection of its
  * own, without the link: this is no part of the flight.
  */
private[flight] final class ContactWatch private (
    client: AirSimClient,
    vehicles: Vector[VehicleClient],
    period: Span,
    clock: Clock,
    recorder: Recorder
)(using system: ActorSystem):
  import ContactWatch.*
  import system.dispatcher

  @volatile private var closed = false
  private var last             = vehicles.map(_ => Option.empty[Collision])

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

  /** Asks once more. */
  def close(): Future[Done] =
    closed = true
    ask().map(note).transformWith(_ => client.close())

private[flight] object ContactWatch:

  /** What was touched before counts for nothing. */
  def start(
      client: AirSimClient,
      vehicles: Vector[VehicleClient],
      period: Span,
      clock: Clock,
      recorder: Recorder
  )(using system: ActorSystem): Future[ContactWatch] =
    import system.dispatcher
    val asked = vehicles.map(_.over(client))
    val watch = ContactWatch(client, asked, period, clock, recorder)
    watch.ask().map: _ =>
      watch.goOn()
      watch

  /** Whoever touches the same thing again within this has not left it. */
  val Within: Span = Span.ofMillis(500)

  def isNew(contact: Collision, before: Option[Collision]): Boolean =
    !before.exists(last =>
      last.objectName == contact.objectName && contact.at.since(last.at) <= Within
    )

  private def told(contact: Collision): String =
    val at = contact.positionNed
    s"${contact.objectName}, at ${at.x.fixed(1)} m north, ${at.y.fixed(1)} m east, ${(-at.z).fixed(1)} m up"
