package skein.forward

import skein.vehicle.Quadrotor

/** Responses by name. */
object VelocityResponses:

  /** The kinematics of the differential game: the velocity is the command. */
  val Ideal: VelocityResponse = Reduced(1, 0, 0)

  /** AirSim's quadrotor with its flight controller at 3 ms, behind AirSim's API: see [[QuadrotorResponse]].
    *
    * @param hoveredS how long it has hovered when the flight starts
    */
  def quadrotor(quadrotor: Quadrotor = Quadrotor.AirSim, hoveredS: Double = 0.0): VelocityResponse =
    QuadrotorResponse(quadrotor, hoveredS)
