package skein.airsim

import java.util.concurrent.atomic.AtomicReference
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Future, Promise}
import skein.policy.Action
import skein.port.{Sensor, VehicleError, VehiclePort}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vehicle.{CarControls, CarDriver, GoTo, SingleTrack}

/** A car of AirSim as a loop's vehicle port. AirSim's cars take pedals and a steering wheel, not velocities:
  * the driver ([[skein.vehicle.CarDriver]]) runs here. It reads the newest reading when an action arrives,
  * and its controls hold until the next action. When the action's duration is over, the car brakes.
  *
  * A velocity's vertical part is ignored; landing brakes. Turning on the spot and attitudes are refused.
  *
  * @param model the car's model that the driver assumes
  */
final class AirSimCar(car: Car, driver: CarDriver = CarDriver(), model: SingleTrack = SingleTrack())(using
    system: ActorSystem
) extends VehiclePort:
  import VehicleErrors.errorOf
  import system.dispatcher
  private type Answer = Either[VehicleError, Boolean]

  private val seen     = AtomicReference(Option.empty[Kinematics])
  private val underWay = AtomicReference(Promise[Answer]())

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] = car
    .status()
    .map: answer =>
      answer.foreach(reading => seen.set(Some(reading.value.kinematics)))
      VehicleErrors.reading(answer)

  def act(action: Action, lasts: Span): Future[Answer] = action match
    case Action.VelocityAt(north, east, _, _) => drive(lasts)(_ => (north, east))
    case Action.Velocity(velocity, _)         => drive(lasts)(_ => (velocity.x, velocity.y))
    case along: Action.Along                  => act(along.byVelocity, lasts)
    case Action.Position(place, speed, _)     =>
      drive(lasts): now =>
        val wanted = GoTo.velocityNed(now.positionNed, now.velocityNed, place, speed)
        (wanted.x, wanted.y)
    case Action.Hover | Action.Land  => hover()
    case Action.Turn(_)              => unsupported("turn on the spot")
    case Action.Attitude(_, _, _, _) => unsupported("keep an attitude")

  def hover(): Future[Answer] =
    val done = Promise[Answer]()
    replace(done, CarControls.Stop)(_ => done.trySuccess(Right(true)): Unit)
    done.future

  override val sensors: Map[String, Sensor] = AirSimSensors.of(car)

  private def unsupported(what: String): Future[Answer] =
    Future.successful(Left(VehicleError.Unsupported(s"${car.name} is a car, which cannot $what")))

  /** @param wanted the car's velocity to north and east, m/s, as a function of its motion */
  private def drive(lasts: Span)(wanted: Kinematics => (Double, Double)): Future[Answer] = seen.get match
    // Sent immediately, so that actions leave in the order of the calls.
    case Some(now) => drive(now, wanted(now), lasts)
    case None      =>
      read().flatMap:
        case Left(error)    => Future.successful(Left(error))
        case Right(reading) => drive(reading.value, wanted(reading.value), lasts)

  private def drive(now: Kinematics, wanted: (Double, Double), lasts: Span): Future[Answer] =
    val (north, east) = wanted
    val speed         = now.orientation.toBody(now.velocityNed).x
    val ended         = Promise[Answer]()
    replace(ended, driver.controls(model, now.orientation.yawRad, speed, north, east)): _ =>
      val over = system.scheduler.scheduleOnce(lasts.toDuration)(expire(ended))
      ended.future.onComplete(_ => over.cancel())
    ended.future

  /** Replaces the car's controls. The action before ends once the new controls have arrived. */
  private def replace(next: Promise[Answer], controls: CarControls)(arrived: Unit => Unit): Unit =
    val (before, taken) = synchronized((underWay.getAndSet(next), car.setControls(controls)))
    taken.foreach:
      case Right(()) =>
        before.trySuccess(Right(false))
        arrived(())
      case Left(error) =>
        before.trySuccess(Left(errorOf(error)))
        next.trySuccess(Left(errorOf(error))): Unit

  /** Stops the car, unless a newer action has been sent. */
  private def expire(ended: Promise[Answer]): Unit = synchronized:
    if (underWay.get eq ended) && ended.trySuccess(Right(true)) then
      car.setControls(CarControls.Stop): Unit
