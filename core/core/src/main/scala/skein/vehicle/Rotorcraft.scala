package skein.vehicle

import skein.units.Vector3

/** A multirotor with its flight controller, which is simulated in whole steps: AirSim's ([[Quadrotor]]), or
  * one whose body another physics engine simulates. All of its state that can be read is in a
  * [[QuadrotorState]].
  */
trait Rotorcraft:
  /** Its geometry, for its appearance and its contacts with ground and scene. */
  def airframe: Airframe

  def gains: ControllerGains

  /** Gains that a client has set; they replace those of [[gains]]. */
  def cascade: Option[CascadeGains]

  def stepS: Double

  /** Advances `state` by one step under a setpoint. */
  def step(state: QuadrotorState, setpoint: Setpoint, environment: Environment): Unit

  /** This vehicle with other gains. After the change, call [[QuadrotorState.restartController]] on a state of
    * the old vehicle.
    */
  def tuned(cascade: CascadeGains): Rotorcraft

  /** Sets `state` to rest on the ground at the origin with its motors off. */
  def land(state: QuadrotorState, yawRad: Double): Unit

  /** Sets `state` to that of a vehicle which has held `goalNed` for long at this yaw, [[hoverSagM]] below it.
    */
  def hover(state: QuadrotorState, goalNed: Vector3, yawRad: Double, environment: Environment): Unit

  /** Distance below its altitude goal at which a hovering vehicle settles, m. */
  def hoverSagM(downM: Double, environment: Environment = Environment.Calm): Double
