package skein.solver

import org.apache.pekko.Done
import scala.concurrent.Future

/** What messages cross between a flight and a solver. It may lose, delay, repeat and reorder them; it never
  * changes one.
  */
trait MessageLink:

  /** How often a flight and its solver greet one another before the flight, so that the first questions do
    * not wait for what they cross to be compiled.
    */
  def rehearsals: Int = 0

  /** Begins to reach for the other side, and goes on until it is closed.
    *
    * @param received told of every message, one at a time
    * @param news told when the other side is reached, and when no longer; by no thread that is still in here
    */
  def open(received: Array[Byte] => Unit, news: LinkNews => Unit): OpenLink

/** A [[MessageLink]] under way. */
trait OpenLink:

  /** Sends if it can at once: never waits.
    *
    * @return or why the message is lost already
    */
  def send(message: Array[Byte]): Either[String, Unit]

  def close(): Future[Done]

/** How it stands with the other side. */
enum LinkNews:
  case Up
  case Down(reason: String)

  /** What it goes through does not let this side in, and is not tried again. */
  case Refused(reason: String)
