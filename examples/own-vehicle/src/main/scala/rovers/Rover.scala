package rovers

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.QueueOfferResult
import org.apache.pekko.stream.scaladsl.{Framing, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{Future, Promise}
import scala.jdk.CollectionConverters.*
import skein.link.{Address, Transport}
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** The adapter: a robot that speaks [[RoverSimulator]]'s protocol, as a loop's vehicle port. */
final class Rover(transport: Transport, address: Address, clock: Clock)(using system: ActorSystem)
    extends VehiclePort:
  import Rover.Patience
  import VehicleError.*
  import system.dispatcher
  private type Answer = Either[VehicleError, List[String]]
  private val waiting        = ConcurrentHashMap[String, Promise[Answer]]()
  private val numbers        = AtomicLong()
  private val (lines, ended) = Source
    .queue[ByteString](RoverSimulator.MostAtOnce)
    .via(transport.connect(address))
    .via(Framing.delimiter(ByteString("\n"), RoverSimulator.LongestLine))
    .map(_.utf8String.split(' ').toList)
    .toMat(Sink.foreach(words =>
      Option(waiting.remove(words.head)).foreach(_.trySuccess(Right(words.tail)))
    ))(Keep.both)
    .run()
  ended.onComplete: _ =>
    waiting.values.asScala.foreach(_.trySuccess(Left(Lost(
      s"the connection to $address ended",
      mayHaveRun = true
    ))))

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
    val sentAt = clock.now()
    ask("read", Patience).map(_.flatMap:
      case "at" :: at :: numbers if numbers.size == 4 && (at :: numbers).forall(_.toDoubleOption.isDefined) =>
        val List(north, east, heading, speed) = numbers.map(_.toDouble): @unchecked
        val velocityNed = Vector3(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading), 0)
        val attitude    = Quaternion(StrictMath.cos(heading / 2), 0, 0, StrictMath.sin(heading / 2))
        val kinematics  = Kinematics(Vector3(north, east, 0), velocityNed, attitude, Vector3.Zero)
        Right(Stamped(kinematics, Instant.ofNanos(at.toDouble.toLong), sentAt, clock.now()))
      case other => wrong("at, a time and four numbers", other))

  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = action.byVelocity match
    case Action.Velocity(velocity, _)         => drive(velocity.x, velocity.y, lasts)
    case Action.VelocityAt(north, east, _, _) => drive(north, east, lasts)
    case Action.Hover                         => hover()
    case other => Future.successful(Left(Unsupported(s"a robot on wheels drives and stops; got $other")))

  def hover(): Future[Either[VehicleError, Boolean]] = done(ask("stop", Patience))

  private def drive(north: Double, east: Double, lasts: Span) =
    done(ask(s"drive $north $east ${lasts.toSeconds}", lasts + Patience))

  private def done(answer: Future[Answer]) = answer.map(_.flatMap:
    case List("done", whole) => Right(whole == "true")
    case other               => wrong("done", other))

  private def wrong(expected: String, came: List[String]): Left[VehicleError, Nothing] = came match
    case "no" :: why => Left(Refused(why.mkString(" ")))
    case other       => Left(Malformed(s"expected $expected from $address, got '${other.mkString(" ")}'"))

  private def ask(words: String, within: Span): Future[Answer] =
    val number = numbers.incrementAndGet().toString
    val answer = Promise[Answer]()
    waiting.put(number, answer): Unit
    lines.offer(ByteString(s"$number $words\n")) match
      case QueueOfferResult.Enqueued => ()
      case QueueOfferResult.Dropped  => answer.success(
          Left(Overloaded(s"more than ${RoverSimulator.MostAtOnce} lines wait for $address"))
        ): Unit
      case _ => answer.trySuccess(Left(Unreachable(s"nobody answers at $address"))): Unit
    val late = system.scheduler.scheduleOnce(within.toDuration):
      val late = TimedOut(s"no answer to '$words' from $address within ${within.toMillis} ms")
      answer.trySuccess(Left(late)): Unit
    answer.future.andThen: _ =>
      late.cancel()
      waiting.remove(number): Unit

object Rover:
  private val Patience = Span.ofMillis(500)
