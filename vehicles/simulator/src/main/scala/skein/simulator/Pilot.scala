package skein.simulator

import skein.units.Instant
import skein.vehicle.Setpoint

/** Something on board that flies a vehicle: asked every 20 ms of simulated time, as the calls of AirSim's API
  * are.
  *
  * @return None where it leaves the vehicle to others
  */
private[simulator] trait Pilot:
  def turn(vehicle: SimulatedMultirotor, at: Instant): Option[Setpoint]
