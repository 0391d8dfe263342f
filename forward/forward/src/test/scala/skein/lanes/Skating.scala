package skein.lanes

import skein.vehicle.{ObservedPlant, PlaneReading}

final case class Sliding(headingRad: Double, speedMps: Double, eastM: Double, northM: Double)

/** A vehicle that turns towards the commanded velocity and slides along its heading. Readings contain its
  * whole state, in other coordinates. The product does not contain this plant.
  */
final case class Skating(lagS: Double, turnPerS: Double, stepS: Double = 0.04)
    extends ObservedPlant[Sliding]:
  override def deadTimeS: Double = 0.02
  def initial: Sliding           = Sliding(0, 0, 0, 0)

  def step(state: Sliding, northMps: Double, eastMps: Double, dtS: Double): Sliding =
    val error = math.IEEEremainder(StrictMath.atan2(eastMps, northMps) - state.headingRad, 2 * math.Pi)
    val told  = StrictMath.hypot(northMps, eastMps)
    val rad   = state.headingRad + turnPerS * error * dtS * (told / (told + 0.1))
    val speed = state.speedMps + (told - state.speedMps) * (1 - StrictMath.exp(-dtS / lagS))
    Sliding(
      rad,
      speed,
      state.eastM + speed * dtS * StrictMath.sin(rad),
      state.northM + speed * dtS * StrictMath.cos(rad)
    )

  def read(state: Sliding): PlaneReading = PlaneReading(
    state.northM,
    state.eastM,
    state.speedMps * StrictMath.cos(state.headingRad),
    state.speedMps * StrictMath.sin(state.headingRad)
  )

  def corrected(state: Sliding, seen: PlaneReading): Sliding = Sliding(
    StrictMath.atan2(seen.eastMps, seen.northMps),
    StrictMath.hypot(seen.northMps, seen.eastMps),
    seen.eastM,
    seen.northM
  )
