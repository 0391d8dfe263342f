package skein.flight

import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.units.Decimals.fixed

/** Checks whether a vehicle can have moved from one reading to the next. One that cannot was placed
  * elsewhere: by another client's `reset` or pose, or because the answer belonged to another vehicle.
  */
private[flight] object Displacement:

  /** Checks two readings.
    *
    * @param to a later reading of the vehicle, by a running clock
    * @return what is wrong, in a line for a person
    */
  def between(
      vehicle: String,
      from: Stamped[Kinematics],
      to: Stamped[Kinematics]
  ): Option[String] =
    val s       = to.validAt.since(from.validAt).toSeconds
    val (a, b)  = (from.value, to.value)
    val flown   = (a.velocityNed + b.velocityNed) * (s / 2)
    val off     = (b.positionNed - a.positionNed - flown).norm
    val allowed = (b.velocityNed - a.velocityNed).norm * s / 2 + MostAccelerationMps2 * s * s / 4 + TouchM
    Option.when(s > 0 && off > allowed):
      s"$vehicle is ${off.fixed(1)} m from where it can have flown in ${s.fixed(2)} s: the simulator was " +
        "started again, another client reset it or put it elsewhere, or its state is another vehicle's"

  /** Greatest plausible acceleration, m/s²: three times gravity; AirSim's multirotor reaches less than two.
    */
  private val MostAccelerationMps2 = 30.0

  /** Tolerance of the distance: covers the jump of a collision, and time stamps that are off by some
    * milliseconds at 30 m/s.
    */
  private val TouchM = 0.5
