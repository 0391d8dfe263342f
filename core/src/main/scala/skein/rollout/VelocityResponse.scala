package skein.rollout

import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.*

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

  // The same as the vehicle tells it when it is asked.
  def seenX: Double  = x
  def seenY: Double  = y
  def seenVx: Double = vx
  def seenVy: Double = vy

  /** All that it tells. Where a vehicle knows no more than its horizontal motion: level, not turning, at z = 0. */
  def seen: Kinematics = level(0)

  protected def level(downM: Double): Kinematics =
    Kinematics(Vector3(seenX, seenY, downM), Vector3(seenVx, seenVy, 0), Quaternion.Identity, Vector3.Zero)

/** How a vehicle answers to commanded velocities. */
trait VelocityResponse:
  def create(): Vehicle

  /** From the arrival of a command until it acts in the place of another, s. The first acts at once. */
  def handoverS: Double = 0.0

  /** What carries readings of such a vehicle forward best. */
  def predictor: VehicleModel[?] = QuadrotorModel.AirSim

object VelocityResponse:

  /** The kinematics of the differential game: the velocity is the command. */
  val Ideal: VelocityResponse = Reduced(1, 0, 0)

  /** AirSim's quadrotor with its flight controller at 3 ms, behind AirSim's API: see [[QuadrotorResponse]].
    *
    * @param hoveredS
    *   how long it has hovered when the flight starts
    */
  def quadrotor(quadrotor: Quadrotor = Quadrotor.AirSim, hoveredS: Double = 0.0): VelocityResponse =
    QuadrotorResponse(quadrotor, hoveredS)

/** A first-order model of the response to commanded velocity: v' = (gain · command(t − deadTime) − v) / lag.
  *
  * @param lagS
  *   0: the velocity jumps
  */
final case class Reduced(gain: Double, lagS: Double, deadTimeS: Double) extends VelocityResponse:
  require(lagS >= 0 && deadTimeS >= 0, s"lag $lagS s and dead time $deadTimeS s must not be negative")
  def create(): Vehicle = LagVehicle(this)

  def model: ReducedModel = ReducedModel.lag(gain, lagS, deadTimeS)

  override def predictor: VehicleModel[?] =
    // A model needs a lag above 0; within a nanosecond nothing happens.
    ReducedVehicleModel(ReducedModel.lag(gain, lagS.max(1e-9), deadTimeS))

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
  private var down               = 0.0
  private var now                = 0.0
  private var wantedX, wantedY   = 0.0
  private val at, atX, atY       = Array.ofDim[Double](Pending)
  private var first, behindFirst = 0

  def start(x0: Double, y0: Double, z: Double): Unit =
    x = x0; y = y0; vx = 0; vy = 0; down = z
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

  override def seen: Kinematics = level(down)

  private def glide(until: Double): Unit =
    val dt = until - now
    if model.lagS > 0 then
      val keep = StrictMath.exp(-dt / model.lagS)
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
