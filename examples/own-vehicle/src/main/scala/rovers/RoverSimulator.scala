package rovers

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Framing, Sink}
import org.apache.pekko.util.ByteString
import scala.concurrent.{Future, Promise}
import skein.link.{Address, Transport}
import skein.units.*
import skein.vehicle.PlantFlight

/** A simulated robot on wheels that listens on a port of its own. Lines of text, with a leading number that
  * the answer repeats:
  *
  * {{{
  * 7 read                  7 at 1250000000 3.2 -1.5 0.7 1.0     clock, ns; north and east, m; heading, rad; speed, m/s
  * 8 drive 1.0 0.5 10.0    8 done false                         replaced by the next drive; true after 10 s
  * 9 stop                  9 done true
  * }}}
  *
  * @param start start of its clock, common to all robots of a flight
  */
final class RoverSimulator(northM: Double, eastM: Double, clock: Clock, start: Instant)(using
    system: ActorSystem
):
  import RoverSimulator.*
  import system.dispatcher
  private val flight  = PlantFlight(RoverPlant())
  private var driving = Promise[Boolean]()
  flight.start(0, Driving(northM, eastM, 0, 0))

  /** @return the address at which it listens */
  def listen(transport: Transport, host: String = "127.0.0.1"): Future[Address] =
    val lines = Flow[ByteString]
      .via(Framing.delimiter(ByteString("\n"), LongestLine))
      .mapAsyncUnordered(MostAtOnce)(line => answer(line.utf8String.split(' ').toList))
      .map(line => ByteString(s"$line\n"))
    transport.listen(Address(host, 0)).to(Sink.foreach(_.flow.join(lines).run(): Unit)).run().map(_.address)

  private def answer(words: List[String]): Future[String] = synchronized:
    val now = clock.now().since(start)
    flight.advance(now.toSeconds)
    words match
      case List(number, "read") =>
        val Driving(north, east, heading, speed) = flight.state
        Future.successful(s"$number at ${now.toNanos} $north $east $heading $speed")
      case List(number, "stop") =>
        replace(now, 0, 0)
        Future.successful(s"$number done true")
      case List(number, "drive", Number(north), Number(east), Number(seconds)) =>
        val replaced = replace(now, north, east)
        val over     =
          after(Span.ofSeconds(seconds).toDuration)(Future.successful(replaced.trySuccess(true): Unit))
        Future.firstCompletedOf(Seq(replaced.future, over.flatMap(_ => replaced.future))).map(done =>
          s"$number done $done"
        )
      case number :: rest =>
        Future.successful(s"$number no expected read, stop or drive, got '${rest.mkString(" ")}'")
      case Nil => Future.successful("0 no expected a number and a word, got nothing")

  private def replace(now: Span, north: Double, east: Double): Promise[Boolean] =
    driving.trySuccess(false): Unit
    flight.act(now.toSeconds, north, east)
    driving = Promise()
    driving

object RoverSimulator:
  val LongestLine = 128
  val MostAtOnce  = 8

  private object Number:
    def unapply(text: String): Option[Double] = text.toDoubleOption.filter(_.isFinite)
