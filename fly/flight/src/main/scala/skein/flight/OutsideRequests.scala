package skein.flight

import scala.collection.immutable.VectorMap

/** Users' requests to flights, from any thread, before and during the flights. A request to a flight that has
  * not begun takes effect at its first decision; a request to end it while its vehicles move to their starts
  * cancels it.
  */
final class OutsideRequests:
  import OutsideRequests.*
  private var flown   = Option.empty[LiveFlights]
  private var ended   = Option.empty[String]
  private var waiting = VectorMap.empty[String, Waiting]

  def stop(id: String, why: String): Unit =
    asked(id)(_.stop(_, why), waiting => waiting.copy(stopped = waiting.stopped.orElse(Some(why))))

  /** Pauses one flight's decisions: its vehicles hover until it continues. */
  def pause(id: String, who: String): Unit = asked(id)(_.pause(_, who), _.copy(paused = Some(who)))

  def continue(id: String, who: String): Unit = asked(id)(_.continue(_, who), _.copy(paused = None))

  def stopAll(why: String): Unit = synchronized:
    ended = ended.orElse(Some(why))
    flown.foreach(_.stop())

  /** Why a flight that has not begun must not begin, if so. */
  def calledOff(id: String): Option[String] = synchronized:
    waiting.get(id).flatMap(_.stopped).orElse(ended)

  /** Passes later requests to these flights. */
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
