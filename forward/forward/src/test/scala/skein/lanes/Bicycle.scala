package skein.lanes

import skein.vehicle.{PlaneReading, Plant}

/** The state of a bicycle at the middle between its wheels. */
final case class Rolling(
    northM: Double,
    eastM: Double,
    headingRad: Double,
    speedMps: Double,
    steeredRad: Double
)

/** A kinematic bicycle that steers towards the commanded velocity. Its position is read at an antenna ahead
  * of its middle. The product does not contain this plant.
  */
final case class Bicycle(
    wheelbaseM: Double,
    steeringLagS: Double,
    mostMps2: Double,
    antennaM: Double,
    stepS: Double = 0.05
) extends Plant[Rolling]:
  def initial: Rolling = Rolling(0, 0, 0, 0, 0)

  override def deadTimeS: Double = 0.03

  def step(state: Rolling, northMps: Double, eastMps: Double, dtS: Double): Rolling =
    val wantedRad = math.IEEEremainder(StrictMath.atan2(eastMps, northMps) - state.headingRad, 2 * math.Pi)
    val share     = 1 - StrictMath.exp(-dtS / steeringLagS)
    val steered   = state.steeredRad + share * (wantedRad.max(-0.6).min(0.6) - state.steeredRad)
    val most      = mostMps2 * dtS
    val speed = state.speedMps + (StrictMath.hypot(northMps, eastMps) - state.speedMps).max(-most).min(most)
    val turn  = speed * dtS * StrictMath.sin(steered) / (wheelbaseM * StrictMath.cos(steered))
    val along = state.headingRad + turn / 2
    Rolling(
      state.northM + speed * dtS * StrictMath.cos(along),
      state.eastM + speed * dtS * StrictMath.sin(along),
      state.headingRad + turn,
      speed,
      steered
    )

  def read(state: Rolling): PlaneReading =
    val (cos, sin) = (StrictMath.cos(state.headingRad), StrictMath.sin(state.headingRad))
    PlaneReading(
      state.northM + antennaM * cos,
      state.eastM + antennaM * sin,
      state.speedMps * cos,
      state.speedMps * sin
    )
