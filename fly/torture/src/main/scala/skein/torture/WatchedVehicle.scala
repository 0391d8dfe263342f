package skein.torture

import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Success
import skein.policy.Action
import skein.port.{Sensor, SteppedTime, VehicleError, VehiclePort}
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** A move sent by the loop. A move that is not a velocity is identified only by its index in the sequence of
  * moves.
  *
  * @param north north component, m/s; 0 if the move is not a velocity
  */
final case class Sending(at: Instant, north: Float, east: Float)

/** A state that a vehicle reported.
  *
  * @param question number of the vehicle's request
  */
final case class ReportedState(question: Long, state: Stamped[Kinematics])

/** A port that records its calls: their start and end, the reported states, and the number of unfinished
  * calls.
  *
  * @param eyes further sensors, which count their calls themselves
  */
final class WatchedVehicle(port: VehiclePort, clock: Clock, eyes: Map[String, Sensor] = Map.empty)(using
    ExecutionContext
) extends VehiclePort:
  private val moves = mutable.ArrayBuffer.empty[Sending]
  private val told  = mutable.ArrayBuffer.empty[ReportedState]

  val reads, commands, measurements = CallCount()

  override val sensors: Map[String, Sensor] =
    port.sensors.map((name, sensor) => name -> WatchedSensor(sensor, measurements)) ++ eyes

  private var lastIsHover = false

  def sendings: Vector[Sending] = moves.toVector

  /** The answers in the order of receipt. */
  def answers: Vector[ReportedState] = told.toVector

  def toldToHover: Boolean = lastIsHover

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
    val question = reads.begun.toLong
    reads
      .count(port.read())
      .andThen:
        case Success(Right(state)) => told += ReportedState(question, state)

  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
    val (north, east) = action.byVelocity match
      case Action.VelocityAt(north, east, _, _) => (north, east)
      case Action.Velocity(velocityNed, _)      => (velocityNed.x, velocityNed.y)
      case _                                    => (0.0, 0.0)
    moves += Sending(clock.now(), north.toFloat, east.toFloat)
    lastIsHover = false
    commands.count(port.act(action, lasts))

  def hover(): Future[Either[VehicleError, Boolean]] =
    lastIsHover = true
    commands.count(port.hover())

/** A sensor that counts its calls, begun and ended. */
private final class WatchedSensor(sensor: Sensor, calls: CallCount)(using ExecutionContext) extends Sensor:
  export sensor.columns
  def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] = calls.count(sensor.read())

/** A stepper that counts its calls, begun and ended. */
final class WatchedTime(stepper: SteppedTime)(using ExecutionContext) extends SteppedTime:
  val calls = CallCount()

  def pause(): Future[Either[VehicleError, Unit]]                 = calls.count(stepper.pause())
  def resume(): Future[Either[VehicleError, Unit]]                = calls.count(stepper.resume())
  def continueFor(span: Span): Future[Either[VehicleError, Unit]] = calls.count(stepper.continueFor(span))

/** Counts of calls that were begun and ended. */
final class CallCount:
  var begun, ended, most = 0

  def count[A](call: Future[A])(using ExecutionContext): Future[A] =
    begun += 1
    most = most.max(begun - ended)
    call.andThen(_ => ended += 1)
