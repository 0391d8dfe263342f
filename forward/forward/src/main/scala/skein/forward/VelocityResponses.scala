package skein.forward

import skein.vehicle.{Quadrotor, ReducedModel}

/** Creates the responses of common kinds of vehicles, such as AirSim's quadrotor. */
object VelocityResponses:

  /** Stands in for a lag of zero, s: it ends within a nanosecond. */
  private val NoLagS = 1e-12

  /** The kinematics of the differential game: the velocity equals the command. */
  val Ideal: VelocityResponse = lag(1, 0, 0)

  /** A first-order lag: v' = (gain · command(t − deadTime) − v) / lag.
    *
    * @param lagS s; with 0 the velocity follows a command immediately
    */
  def lag(gain: Double, lagS: Double, deadTimeS: Double): PlantResponse =
    require(lagS >= 0, s"a lag must not be negative, got $lagS s")
    PlantResponse(ReducedModel.lag(gain, lagS.max(NoLagS), deadTimeS))

  /** AirSim's quadrotor with its flight controller at 3 ms, behind AirSim's API: see [[QuadrotorResponse]].
    *
    * @param hoveredS time for which the vehicle has hovered when the flight starts, s
    */
  def quadrotor(quadrotor: Quadrotor = Quadrotor.AirSim, hoveredS: Double = 0.0): VelocityResponse =
    QuadrotorResponse(quadrotor, hoveredS)
