package rovers

import skein.forecast.Structure
import skein.policy.{Axis, SearchSpace}
import skein.vehicle.{ObservedPlant, PlaneReading}

/** A robot's position, heading and speed. */
final case class Driving(northM: Double, eastM: Double, headingRad: Double, speedMps: Double)

/** A robot's motion: it turns towards its commanded direction, and drives slower the more it has to turn.
  *
  * @param turnPerS turn rate over the remaining angle, 1/s
  * @param lagS time constant of its speed, s
  */
final case class RoverPlant(
    turnPerS: Double = 3,
    mostRadPerS: Double = 1.5,
    lagS: Double = 0.4,
    override val deadTimeS: Double = 0
) extends ObservedPlant[Driving]:
  def initial: Driving = Driving(0, 0, 0, 0)
  def stepS: Double    = 0.01

  def step(state: Driving, northMps: Double, eastMps: Double, dtS: Double): Driving =
    val goal  = StrictMath.hypot(northMps, eastMps)
    val error = if goal < 0.01 then 0.0
    else Math.IEEEremainder(StrictMath.atan2(eastMps, northMps) - state.headingRad, 2 * Math.PI)
    val heading = state.headingRad + (turnPerS * error).max(-mostRadPerS).min(mostRadPerS) * dtS
    val wanted  = goal.min(RoverPlant.MostMps) * StrictMath.cos(error).max(0)
    val speed   = state.speedMps + (wanted - state.speedMps) * dtS / lagS
    Driving(
      state.northM + speed * StrictMath.cos(heading) * dtS,
      state.eastM + speed * StrictMath.sin(heading) * dtS,
      heading,
      speed
    )

  def read(state: Driving): PlaneReading = PlaneReading(
    state.northM,
    state.eastM,
    state.speedMps * StrictMath.cos(state.headingRad),
    state.speedMps * StrictMath.sin(state.headingRad)
  )

  /** Corrects the state with a reading; at rest, its velocity does not determine the heading. */
  def corrected(state: Driving, seen: PlaneReading): Driving =
    val speed   = StrictMath.hypot(seen.northMps, seen.eastMps)
    val heading = if speed > 0.01 then StrictMath.atan2(seen.eastMps, seen.northMps) else state.headingRad
    Driving(seen.northM, seen.eastM, heading, speed)

object RoverPlant:
  val MostMps = 3.0

  /** The structure whose parameters `identify` fits to drives. */
  val structure: Structure = Structure(
    "rover",
    SearchSpace(Vector(
      Axis("turn-per-s", 0.5, 10, 2),
      Axis("most-rad-per-s", 0.2, 5, 1),
      Axis("lag-s", 0.05, 3, 1),
      Axis("dead-time-s", 0, 0.5, 0.05)
    )),
    values => RoverPlant(values(0), values(1), values(2), values(3))
  )
