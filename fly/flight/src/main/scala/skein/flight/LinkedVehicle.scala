package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{Future, Promise}
import scala.util.Try
import skein.policy.Action
import skein.port.{Sensor, VehicleError, VehiclePort}
import skein.signal.{
  Kinematics,
  LatencyProfile,
  LatencySampler,
  PacketLoss,
  Retransmission,
  SplitMix64,
  Stamped
}
import skein.units.*

/** A vehicle behind an emulated link, for adapters without bytes to delay: each call and each answer is
  * delayed by the link's latency, in order; a lost one is sent again, as by TCP.
  *
  * @param line the vehicle's index among those behind this link
  */
final class LinkedVehicle(
    vehicle: VehiclePort,
    latency: LatencyProfile,
    seed: Long,
    line: Int,
    clock: Clock
)(using
    system: ActorSystem
) extends VehiclePort:
  import system.dispatcher
  private val timeout = Retransmission.timeout(latency)
  private val there   = Direction(2 * line)
  private val back    = Direction(2 * line + 1)

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] = over(vehicle.read())

  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
    called(vehicle.act(action, lasts))

  def hover(): Future[Either[VehicleError, Boolean]] = called(vehicle.hover())

  override def sensors: Map[String, Sensor] = vehicle.sensors.map: (name, sensor) =>
    name -> new Sensor:
      def columns: Vector[String]                                       = sensor.columns
      def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] = over(sensor.read())

  private def called[A](call: => Future[A]): Future[A] =
    there.pass(call).flatMap(answer => back.pass(Future.successful(answer)))

  private def over[A](ask: => Future[Either[VehicleError, Stamped[A]]]) =
    val sentAt = clock.now()
    // Vehicles behind topics answer with a message that was sent before the request.
    called(ask).map(_.map(read => read.copy(sentAt = read.sentAt.min(sentAt), receivedAt = clock.now())))

  private final class Direction(number: Int):
    private val begun   = clock.now()
    private val sampler = LatencySampler(latency, seed, seed * 1_000_003 + number)
    private val loss    =
      PacketLoss(latency, SplitMix64.seedOf(seed, 5), SplitMix64.seedOf(seed, 6 + number))
    private var newest = begun

    /** Completes when everything before has passed: timers that expire in one moment have no order. */
    private var last = Future.unit

    def pass[A](call: => Future[A]): Future[A] =
      val passed = Promise[Future[A]]()
      synchronized:
        val now = clock.now()
        val at  = now.since(begun)
        newest = newest.max(now + loss.delay(at, timeout) + sampler.oneWay(at))
        last = last.zip(after(newest.since(now).toDuration)(Future.unit)).map(_ =>
          passed.complete(Try(call)): Unit
        )
      passed.future.flatten
