package skein.scenario

import skein.policy.*
import skein.units.*

/** Shared by Skein's scenarios in which all vehicles fly at one altitude. */
private object AtOneAltitude:
  val MostVehicles = 100

  def agent(
      name: String,
      role: Role,
      speedMps: Double,
      northM: Double,
      eastM: Double,
      altitudeM: Double,
      headingRad: Double,
      policy: Policy
  ): Agent =
    Agent(
      name,
      role,
      MetresPerSecond(speedMps),
      Vector3(northM, eastM, -altitudeM),
      Radians(headingRad),
      policy
    )
