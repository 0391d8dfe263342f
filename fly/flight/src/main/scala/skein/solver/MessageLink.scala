package skein.solver

import org.apache.pekko.Done
import scala.concurrent.Future

/** A link for messages between a flight and a solver. It may lose, delay, repeat and reorder them; it never
  * changes one.
  */
trait MessageLink:

  /** Number of greetings between a flight and its solver before the flight, which compile the code of the
    * link before the first requests.
    */
  def rehearsals: Int = 0

  /** Connects to the other side, with retries until it is closed.
    *
    * @param received called with every message, one at a time
    * @param news called when the other side becomes reachable or unreachable; never from within this call
    */
  def open(received: Array[Byte] => Unit, news: LinkNews => Unit): OpenLink

/** A [[MessageLink]] that is open, until it is closed. */
trait OpenLink:

  def send(message: Array[Byte]): Either[String, Unit]

  def close(): Future[Done]

/** A change of the connection to the other side. */
enum LinkNews:
  case Up
  case Down(reason: String)

  /** The other side, or a node between, rejects this side; there are no retries. */
  case Refused(reason: String)
