package skein.flight

import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.{Multirotor, VehicleClient}
import skein.link.Address

/** Checks with a simulator whether a flight still controls its vehicles: under API control and in the air. It
  * uses a separate connection, since this is not part of the flight.
  *
  * @param vehicles the flight's vehicles
  * @param isLanding whether the flight itself commanded a vehicle to land
  */
private[flight] final class Custody(
    vehicles: Vector[VehicleClient],
    simulator: Address,
    isLanding: String => Boolean
)(using ExecutionContext):
  import Custody.*

  private val known = AtomicReference(Known())

  /** Requests the vehicles' states.
    *
    * @return `Left` if the simulator did not answer, else why the flight cannot continue, if it cannot
    */
  def ask(): Future[Either[String, Option[String]]] =
    Future
      .traverse(vehicles)(asked)
      .map: answers =>
        val (failed, held) = answers.partitionMap(identity)
        val before         = known.get
        val (now, why)     = before.heard(held.map(one =>
          if isLanding(one.vehicle) then one.copy(flies = None) else one
        ))
        known.compareAndSet(before, now): Unit
        why match
          case Some(taken) => Right(Some(s"the simulator at $simulator $taken"))
          case None        => failed.headOption.toLeft(None)

  private def asked(vehicle: VehicleClient): Future[Either[String, Held]] =
    val flies = vehicle match
      case multirotor: Multirotor => multirotor.status().map(_.map(status => Some(status.value.flying)))
      case _                      => Future.successful(Right(None))
    for
      controlled <- vehicle.isApiControlEnabled()
      flying     <- flies
    yield for
      control <- controlled.left.map(_.message)
      flight  <- flying.left.map(_.message)
    yield Held(vehicle.name, control, flight)

private[flight] object Custody:
  /** The message that the simulator has taken a vehicle's API control away. */
  def lost(vehicle: String): String =
    s"no longer gives $vehicle to this flight: it was started again or reset, or another client took api " +
      "control away"

  /** The simulator's answer for a vehicle.
    *
    * @param isControlled whether it is under API control
    * @param flies absent if it was not requested
    */
  final case class Held(vehicle: String, isControlled: Boolean, flies: Option[Boolean])

  /** The known states of the vehicles.
    *
    * @param flown the vehicles that were observed in the air: a simulator need not report landings
    * @param landed those that stood on the ground at the last answer
    */
  final case class Known(flown: Set[String] = Set.empty, landed: Set[String] = Set.empty):

    /** Updates the states with the next answers.
      *
      * @return the new states, and why the flight lost a vehicle, if it did
      */
    def heard(held: Vector[Held]): (Known, Option[String]) =
      val stands = held.filter(one => one.flies.contains(false) && flown(one.vehicle)).map(_.vehicle)
      val next   = Known(flown ++ held.filter(_.flies.contains(true)).map(_.vehicle), stands.toSet)
      val taken  = held.find(!_.isControlled).map(one => lost(one.vehicle))
      val down   = stands.find(landed).map(one =>
        s"says that $one has landed: another client landed it, or it fell"
      )
      (next, taken.orElse(down))
