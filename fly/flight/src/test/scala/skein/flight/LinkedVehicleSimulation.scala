package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.collection.mutable
import scala.concurrent.Future
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

class LinkedVehicleSimulation extends munit.FunSuite:
  test("over a link with jitter and loss, no command overtakes another"):
    for seed <- 1L to 5L do
      val arrived = mutable.ArrayBuffer.empty[Double]
      val link    = LatencyProfile.parse("loss:5%,vpn", Left(_)).fold(error => fail(error.message), identity)
      VirtualTime
        .run(seed): system =>
          given ActorSystem = system
          import system.dispatcher
          val clock   = Clock.ofNanos(VirtualTime.clock(system))
          val vehicle = new VehiclePort:
            def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
              Future.failed(IllegalStateException("not read here"))
            def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
              arrived += lasts.toMillis
              Future.successful(Right(true))
            def hover(): Future[Either[VehicleError, Boolean]] = Future.successful(Right(true))
          val linked = LinkedVehicle(vehicle, link, seed, 0, clock)
          Future
            .traverse((1 to 400).toVector): number =>
              after(Span.ofMillis(5.0 * number).toDuration)(
                linked.act(Action.Hover, Span.ofMillis(number.toDouble))
              )
        .value: Unit
      assertEquals(arrived.toSeq, (1 to 400).map(_.toDouble), s"seed $seed")
