package skein.vehicle

import skein.units.Vector3

/** A multirotor with its flight controller, which flies in whole steps: AirSim's ([[Quadrotor]]), or one
  * whose body is another's physics. Its whole readable state is a [[QuadrotorState]].
  */
trait Rotorcraft:
  /** Its geometry, as it appears and as it touches ground and scene. */
  def airframe: Airframe

  def gains: ControllerGains

  /** Gains that a client has set; they replace those of [[gains]]. */
  def cascade: Option[CascadeGains]

  def stepS: Double

  /** Advances `state` by one step under this setpoint. */
  def step(state: QuadrotorState, setpoint: Setpoint, environment: Environment): Unit

  /** This vehicle with other gains. A state that it takes over must [[QuadrotorState.restartController]]. */
  def tuned(cascade: CascadeGains): Rotorcraft

  /** Sets `state` to rest on the ground at the origin with its motors off. */
  def land(state: QuadrotorState, yawRad: Double): Unit

  /** Sets `state` to a vehicle that has long held `goalNed` at this yaw: it hangs [[hoverSagM]] below. */
  def hover(state: QuadrotorState, goalNed: Vector3, yawRad: Double, environment: Environment): Unit

  /** How far below the held altitude a hovering vehicle settles, m. */
  def hoverSagM(downM: Double, environment: Environment = Environment.Calm): Double
