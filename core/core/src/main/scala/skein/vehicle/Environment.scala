package skein.vehicle

import skein.units.Vector3

/** A vehicle's surroundings: air and ground. Constant during a step; pass another when the wind changes.
  *
  * @param windNed velocity of the air, m/s; its only effect is drag
  * @param groundDownM z of the flat ground, NED, m; a vehicle touches it when the vehicle's z reaches this
  * @param originAltitudeM altitude of z = 0 above sea level, m; AirSim's default home lies at 122 m
  */
final case class Environment(
    windNed: Vector3 = Vector3.Zero,
    groundDownM: Double = 0.0,
    originAltitudeM: Double = 122.0
)

object Environment:
  val Calm: Environment = Environment()
