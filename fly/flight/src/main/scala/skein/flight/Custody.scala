package skein.flight

import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.{Multirotor, VehicleClient}
import skein.link.Address

/** Asks a simulator whether it still gives a flight its vehicles: under api control and in the air. It has a
  * connection of its own, since this is no part of the flight.
  *
  * @param vehicles of the flight
  * @param isLanding whether the flight itself told a vehicle to land
  */
private[flight] final class Custody(
    vehicles: Vector[VehicleClient],
    simulator: Address,
    isLanding: String => Boolean
)(using ExecutionContext):
  import Custody.*

  private val known = AtomicReference(Known())

  /** @return `Left` where it did not answer, else why the flight cannot go on, if it cannot
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

  /** What a simulator answers for a vehicle.
    *
    * @param isControlled whether it is under api control
    * @param flies absent where it need not
    */
  final case class Held(vehicle: String, isControlled: Boolean, flies: Option[Boolean])

  /** @param flown vehicles that were seen in the air: a simulator need not know of landings
    * @param landed those that stood on the ground at the last answer
    */
  final case class Known(flown: Set[String] = Set.empty, landed: Set[String] = Set.empty):

    /** With the next answers.
      *
      * @return and what the simulator does with a vehicle that is not the flight's any more
      */
    def heard(held: Vector[Held]): (Known, Option[String]) =
      val stands = held.filter(one => one.flies.contains(false) && flown(one.vehicle)).map(_.vehicle)
      val next   = Known(flown ++ held.filter(_.flies.contains(true)).map(_.vehicle), stands.toSet)
      val taken  = held.find(!_.isControlled).map(one =>
        s"no longer gives ${one.vehicle} to this flight: it was started again or reset, or another client " +
          "took api control away"
      )
      val down = stands.find(landed).map(one =>
        s"says that $one has landed: another client landed it, or it fell"
      )
      (next, taken.orElse(down))
