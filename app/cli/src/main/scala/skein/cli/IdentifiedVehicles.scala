package skein.cli

import skein.measure.FlownVehicle
import skein.vehicle.VehicleKind

/** Chooses the recorded vehicles to which `./skein identify` fits models. */
private[cli] object IdentifiedVehicles:

  /** The vehicles with these names that were commanded velocities; without names, the cars only if there is
    * nothing else.
    *
    * @param say called with a line for each choice that was made for the user
    */
  def chosen(all: Vector[FlownVehicle], names: Seq[String])(
      say: String => Unit
  ): Either[String, Vector[FlownVehicle]] =
    val (cars, others) = all.partition(_.kind == VehicleKind.Car)
    val named          =
      if names.nonEmpty then all.filter(one => names.contains(one.name))
      else if others.isEmpty then cars
      else
        if cars.nonEmpty then say(s"left out: the cars ${listed(cars)}; --vehicle chooses them")
        others
    val (without, wanted) = named.partition(_.stretches.isEmpty)
    if wanted.nonEmpty && without.nonEmpty then
      say(s"left out: ${listed(without)}, commanded by other actions than velocities")
    val unknown = names.filterNot(name => all.exists(_.name == name))
    Either.cond(
      wanted.nonEmpty && unknown.isEmpty,
      wanted,
      if all.isEmpty then "expected recordings with commands to vehicles, got none"
      else if unknown.nonEmpty then
        s"--vehicle: expected one of ${listed(all)}, got ${unknown.mkString(", ")}"
      else s"expected vehicles commanded by velocities, got other actions of ${listed(without)}"
    )

  /** Why Skein's structures, which are of multirotors, do not fit these vehicles. */
  def unlike(vehicles: Vector[FlownVehicle]): Option[String] =
    val cars         = vehicles.filter(_.kind == VehicleKind.Car)
    val (held, free) = vehicles.partition(_.stretches.forall(_.arrivals.forall(_.heldDownM.isDefined)))
    if cars.nonEmpty then Some(s"expected multirotors for a structure of Skein, got the cars ${listed(cars)}")
    else
      Option.when(held.nonEmpty && free.nonEmpty):
        "expected either velocities or velocities that hold an altitude, since the lag depends on it; " +
          s"got both, to ${listed(free)} and ${listed(held)}: --vehicle chooses"

  /** The altitude that all commands held, if it was one. */
  def altitudeM(vehicles: Vector[FlownVehicle]): Option[Double] =
    val all  = vehicles.flatMap(_.stretches).flatMap(_.arrivals).map(_.heldDownM)
    val held = all.flatten.map(-_)
    Option.when(held.size == all.size && held.max - held.min < 0.5)(held.sum / held.size)

  private def listed(vehicles: Vector[FlownVehicle]) = vehicles.map(_.name).distinct.mkString(", ")
