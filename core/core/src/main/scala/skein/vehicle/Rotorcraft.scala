package skein.vehicle

import skein.units.Vector3

/** A multirotor with its flight controller, which flies in whole steps: AirSim's ([[Quadrotor]]), or one
  * whose body is another's physics. All that is read of it is in a [[QuadrotorState]].
  */
trait Rotorcraft:
  /** What it looks like, and what meets ground and scene. */
  def airframe: Airframe

  def gains: ControllerGains

  /** Gains that a client has set, which then stand for those of [[gains]]. */
  def cascade: Option[CascadeGains]

  /** s */
  def stepS: Double

  /** Advances `state` by one step under this setpoint. */
  def step(state: QuadrotorState, setpoint: Setpoint, environment: Environment): Unit

  /** The same vehicle with these gains. A state that it is to fly on must
    * [[QuadrotorState.restartController]].
    */
  def tuned(cascade: CascadeGains): Rotorcraft

  /** Lets `state` stand on the ground at the origin with its motors off, from rest. */
  def land(state: QuadrotorState, yawRad: Double): Unit

  /** Lets `state` be that of a vehicle that has long held `goalNed` at this yaw: it hangs [[hoverSagM]]
    * below.
    */
  def hover(state: QuadrotorState, goalNed: Vector3, yawRad: Double, environment: Environment): Unit

  /** How far below the held altitude a hovering vehicle settles, m. */
  def hoverSagM(downM: Double, environment: Environment = Environment.Calm): Double
