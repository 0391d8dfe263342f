package skein.simulator

import skein.units.Instant
import skein.vehicle.Setpoint

/** An onboard pilot. It is called every 20 ms of simulated time, like an iteration of AirSim's moves.
  *
  * @return None if it leaves control to other pilots
  */
private[simulator] trait Pilot:
  def turn(vehicle: SimulatedMultirotor, at: Instant): Option[Setpoint]
