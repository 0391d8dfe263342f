package skein.forward

import skein.vehicle.{Quadrotor, ReducedModel}

/** Responses by name. */
object VelocityResponses:

  /** In the place of no lag, s: over before the next nanosecond. */
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
    * @param hoveredS how long it has hovered when the flight starts
    */
  def quadrotor(quadrotor: Quadrotor = Quadrotor.AirSim, hoveredS: Double = 0.0): VelocityResponse =
    QuadrotorResponse(quadrotor, hoveredS)
