package skein.rollout

import skein.vehicle.{Environment, Quadrotor, QuadrotorState, ReducedModel, Setpoint}
import skein.units.Vector3

/** One vehicle of a rollout that follows commanded horizontal velocities. Mutable; one per vehicle and thread. */
trait Vehicle:
  /** Places it at rest, at time 0. */
  def start(x: Double, y: Double, z: Double): Unit

  /** A command (m/s, north and east) that acts from now on. */
  def command(vx: Double, vy: Double): Unit

  /** Flies until this time, s; never earlier than the call before. */
  def advance(timeS: Double): Unit

  def x: Double
  def y: Double
  def vx: Double
  def vy: Double

/** How a vehicle answers to commanded velocities. */
trait VelocityResponse:
  def create(): Vehicle

object VelocityResponse:

  /** The kinematics of the differential game: the velocity is the command. */
  val Ideal: VelocityResponse = () => LagVehicle(Reduced(1, 0, 0))

  /** AirSim's quadrotor with its flight controller at 3 ms, commanded by `moveByVelocityZ` at its start altitude. A
    * command acts from the next whole step on; a position is that of the last whole step.
    */
  def quadrotor(quadrotor: Quadrotor = Quadrotor.AirSim): VelocityResponse = () => QuadrotorVehicle(quadrotor)

/** A first-order model of the response to commanded velocity: v' = (gain · command(t − deadTime) − v) / lag.
  *
  * @param lagS
  *   0: the velocity jumps
  */
final case class Reduced(gain: Double, lagS: Double, deadTimeS: Double) extends VelocityResponse:
  require(lagS >= 0 && deadTimeS >= 0, s"lag $lagS s and dead time $deadTimeS s must not be negative")
  def create(): Vehicle = LagVehicle(this)

  def model: ReducedModel = ReducedModel.lag(gain, lagS, deadTimeS)

object Reduced:
  /** AirSim's default quadrotor under `moveByVelocityZ` at z = −20 m, as `./skein identify` fits it to live flights of
    * the paper's duel: gain ± 0.017, lag ± 0.07 s, dead time ± 0.02 s (95 %). Off the full quadrotor by 0.02 m after 1 s
    * and 0.22 m after 5 s (medians). See [[skein.vehicle.ReducedModel.AirSim]], which follows it more closely.
    */
  val AirSim: Reduced = Reduced(gain = 0.919, lagS = 2.66, deadTimeS = 0.053)

/** Integrates [[Reduced]] exactly between the times at which commands begin to act. */
private final class LagVehicle(model: Reduced) extends Vehicle:
  import LagVehicle.Pending
  var x, y, vx, vy               = 0.0
  private var now                = 0.0
  private var wantedX, wantedY   = 0.0
  private val at, atX, atY       = Array.ofDim[Double](Pending)
  private var first, behindFirst = 0

  def start(x0: Double, y0: Double, z: Double): Unit =
    x = x0; y = y0; vx = 0; vy = 0
    now = 0; wantedX = 0; wantedY = 0
    first = 0; behindFirst = 0

  def command(commandedX: Double, commandedY: Double): Unit =
    if behindFirst - first == Pending then
      throw IllegalStateException(s"more than $Pending commands within the dead time of ${model.deadTimeS} s")
    val slot = behindFirst % Pending
    at(slot) = now + model.deadTimeS; atX(slot) = model.gain * commandedX; atY(slot) = model.gain * commandedY
    behindFirst += 1

  def advance(timeS: Double): Unit =
    while first < behindFirst && at(first % Pending) <= timeS do
      val slot = first % Pending
      glide(at(slot))
      wantedX = atX(slot); wantedY = atY(slot)
      if model.lagS == 0 then
        vx = wantedX; vy = wantedY
      first += 1
    glide(timeS)

  private def glide(until: Double): Unit =
    val dt = until - now
    if model.lagS > 0 then
      val keep = math.exp(-dt / model.lagS)
      val gain = model.lagS * (1 - keep)
      x += wantedX * dt + (vx - wantedX) * gain
      y += wantedY * dt + (vy - wantedY) * gain
      vx = wantedX + (vx - wantedX) * keep
      vy = wantedY + (vy - wantedY) * keep
    else
      x += vx * dt; y += vy * dt
    now = until

private object LagVehicle:
  private val Pending = 64

private final class QuadrotorVehicle(quadrotor: Quadrotor) extends Vehicle:
  private val state              = QuadrotorState()
  private var setpoint: Setpoint = Setpoint.Disarmed
  private var down               = 0.0
  private var steps              = 0L

  def start(x: Double, y: Double, z: Double): Unit =
    state.copyFrom(quadrotor.hovering(Vector3(x, y, z)))
    setpoint = Setpoint.hold(Vector3(x, y, z))
    down = z
    steps = 0

  def command(vx: Double, vy: Double): Unit = setpoint = Setpoint.velocityZ(vx, vy, down)

  def advance(timeS: Double): Unit =
    while (steps + 1) * quadrotor.stepS <= timeS + QuadrotorVehicle.Rounding do
      quadrotor.step(state, setpoint, Environment.Calm)
      steps += 1

  def x: Double  = state.x
  def y: Double  = state.y
  def vx: Double = state.vx
  def vy: Double = state.vy

private object QuadrotorVehicle:
  /** A step that ends at the asked time but for rounding belongs to it, s. */
  private val Rounding = 1e-9
