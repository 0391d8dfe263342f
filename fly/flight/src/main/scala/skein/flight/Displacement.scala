package skein.flight

import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.units.Decimals.fixed

/** Whether a vehicle can have flown from one reading to the next. One that cannot was put elsewhere: by
  * another client's `reset` or pose, or because its answer was another vehicle's.
  */
private[flight] object Displacement:

  /** @param to read later, of the same vehicle, by a clock that runs
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

  /** Three times gravity: AirSim's multirotor has less than two. */
  private val MostAccelerationMps2 = 30.0

  /** What a collision may move a vehicle by at once, and what time stamps some milliseconds off make of 30
    * m/s.
    */
  private val TouchM = 0.5
