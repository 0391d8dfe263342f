package skein.forward

import skein.vehicle.{Quadrotor, ReducedModel}

/** Makes responses of vehicles to commanded velocities, such as AirSim's quadrotor. */
object VelocityResponses:

  /** Stands for no lag, s: over before the next nanosecond. */
  private val NoLagS = 1e-12

  /** The kinematics of the differential game: the velocity is the command. */
  val Ideal: VelocityResponse = lag(1, 0, 0)

  /** A first-order lag: v' = (gain · command(t − deadTime) − v) / lag.
    *
    * @param lagS 0: the velocity jumps
    */
  def lag(gain: Double, lagS: Double, deadTimeS: Double): PlantResponse =
    require(lagS >= 0, s"a lag must not be negative, came $lagS s")
    PlantResponse(ReducedModel.lag(gain, lagS.max(NoLagS), deadTimeS))

  /** AirSim's quadrotor with its flight controller at 3 ms, behind AirSim's API: see [[QuadrotorResponse]].
    *
    * @param hoveredS time for which it has hovered when the flight starts, s
    */
  def quadrotor(quadrotor: Quadrotor = Quadrotor.AirSim, hoveredS: Double = 0.0): VelocityResponse =
    QuadrotorResponse(quadrotor, hoveredS)
