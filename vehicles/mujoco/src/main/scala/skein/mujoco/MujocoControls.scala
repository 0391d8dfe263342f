package skein.mujoco

import skein.vehicle.{Airframe, Environment, Quadrotor, QuadrotorState}

/** Converts the rotor controls of AirSim's flight controller to a model's actuators. The controller commands
  * a thrust and three torques for AirSim's quadrotor. The model receives the accelerations that these would
  * cause there, scaled to its own weight: so AirSim's gains fly any mass.
  */
private[mujoco] final class MujocoControls(actuators: MujocoActuators):
  import MujocoControls.*

  private val values = Array.ofDim[Double](actuators.count)

  /** Controls of all actuators; the array is overwritten by the next call.
    *
    * @param isDirect whether the state's controls are the rotors' own and not a controller's: then each is a
    *   fraction of its actuator's range
    */
  def of(state: QuadrotorState, isDirect: Boolean): Array[Double] =
    import state.{control0 as c0, control1 as c1, control2 as c2, control3 as c3}
    actuators.rotors match
      case Some(rotors) if isDirect =>
        set(rotors(0), c0); set(rotors(1), c1); set(rotors(2), c2); set(rotors(3), c3)
      case _ =>
        val up    = (c0 + c1 + c2 + c3) * UpByControl * actuators.weightMps2
        val front = (-c0 + c1 + c2 - c3) * FrontByControl
        val right = (c0 - c1 + c2 - c3) * RightByControl
        val down  = (c0 + c1 - c2 - c3) * DownByControl
        var i     = 0
        while i < values.length do
          val wanted = actuators.resting(i) + actuators.allocation.control(i, up, front, right, down)
          values(i) = math.max(actuators.lowest(i), math.min(wanted, actuators.highest(i)))
          i += 1
    values

  private def set(actuator: Int, share: Double): Unit =
    val rest = actuators.resting(actuator)
    values(actuator) = rest + share * (actuators.full(actuator) - rest)

private[mujoco] object MujocoControls:
  private val airframe = Airframe()

  private[mujoco] val SeaLevel = Environment(originAltitudeM = 0)

  private val torque         = airframe.rotorOffsetM * airframe.maxThrustN
  private val UpByControl    = 1 / (4 * Quadrotor.AirSim.hoverControl(0, SeaLevel))
  private val FrontByControl = torque / airframe.inertiaFront
  private val RightByControl = torque / airframe.inertiaRight
  private val DownByControl  = airframe.maxTorqueNm / airframe.inertiaDown
