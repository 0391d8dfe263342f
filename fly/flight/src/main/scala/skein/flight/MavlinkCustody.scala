package skein.flight

import java.util.concurrent.atomic.AtomicReference

/** Checks whether a flight over MAVLink still controls its vehicles, by the state their autopilots send:
  * armed, and in a mode that follows setpoints.
  *
  * @param vehicles the flight's vehicles, each with the reason why it follows no setpoints, if it does not
  * @param isLanding whether the flight itself commanded a vehicle to land
  */
private[flight] final class MavlinkCustody(
    vehicles: Vector[(name: String, taken: () => Option[String])],
    isLanding: String => Boolean
):
  private val doubted = AtomicReference(Set.empty[String])

  /** Why the flight lost control of a vehicle, if it did; two successive checks must agree. */
  def check(): Option[String] =
    val taken =
      for
        vehicle <- vehicles if !isLanding(vehicle.name)
        why     <- vehicle.taken()
      yield (vehicle.name, why)
    val before = doubted.getAndSet(taken.map(_._1).toSet)
    taken.collectFirst:
      case (name, why) if before(name) => s"$name is no longer this flight's: $why"
