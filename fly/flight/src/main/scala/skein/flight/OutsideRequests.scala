package skein.flight

import scala.collection.immutable.VectorMap

/** What is asked of flights from outside, from any thread, whether they fly already or not. What is asked of
  * a flight that does not fly yet holds from its first decision on; one that is asked to end while its
  * vehicles are brought to their starts goes no further.
  */
final class OutsideRequests:
  import OutsideRequests.*
  private var flown   = Option.empty[LiveFlights]
  private var ended   = Option.empty[String]
  private var waiting = VectorMap.empty[String, Waiting]

  /** Ends one flight; its vehicles hover. */
  def stop(id: String, why: String): Unit =
    asked(id)(_.stop(_, why), waiting => waiting.copy(stopped = waiting.stopped.orElse(Some(why))))

  /** One flight's vehicles hover and nobody decides. */
  def pause(id: String, who: String): Unit = asked(id)(_.pause(_, who), _.copy(paused = Some(who)))

  /** Lets one flight go on that is paused. */
  def continue(id: String, who: String): Unit = asked(id)(_.continue(_, who), _.copy(paused = None))

  /** Ends those that fly, and all that would. */
  def stopAll(why: String): Unit = synchronized:
    ended = ended.orElse(Some(why))
    flown.foreach(_.stop())

  /** Why a flight that does not fly yet must not be begun, if it must not. */
  def calledOff(id: String): Option[String] = synchronized:
    waiting.get(id).flatMap(_.stopped).orElse(ended)

  /** These fly from now on. */
  def flying(flights: LiveFlights): Unit = synchronized:
    flown = Some(flights)
    for (id, asked) <- waiting if flights.has(id) do
      asked.paused.foreach(flights.pause(id, _))
      asked.stopped.foreach(flights.stop(id, _))
    waiting = waiting.filterNot((id, _) => flights.has(id))
    if ended.isDefined then flights.stop()

  private def asked(id: String)(now: (LiveFlights, String) => Unit, later: Waiting => Waiting): Unit =
    synchronized:
      flown.filter(_.has(id)) match
        case Some(flights) => now(flights, id)
        case None          => waiting = waiting.updated(id, later(waiting.getOrElse(id, Waiting())))

object OutsideRequests:
  private final case class Waiting(paused: Option[String] = None, stopped: Option[String] = None)
