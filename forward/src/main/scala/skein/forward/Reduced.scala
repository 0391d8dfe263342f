package skein.forward

import skein.signal.Kinematics
import skein.vehicle.{FirstOrderLag, ReducedModel, PlantModel, VehicleModel}

/** A first-order model of the response to commanded velocity: v' = (gain · command(t − deadTime) − v) / lag.
  *
  * @param lagS 0: the velocity jumps
  */
final case class Reduced(gain: Double, lagS: Double, deadTimeS: Double) extends VelocityResponse:
  require(deadTimeS >= 0, s"a dead time must not be negative, came $deadTimeS s")
  val lag: FirstOrderLag = FirstOrderLag(lagS)
  def create(): Vehicle  = LagVehicle(this)

  def model: ReducedModel = ReducedModel.lag(gain, lagS, deadTimeS)

  override def predictor: VehicleModel[?] =
    // A model needs a lag above 0; within a nanosecond nothing happens.
    PlantModel(ReducedModel.lag(gain, lagS.max(1e-9), deadTimeS))

object Reduced:
  /** AirSim's default quadrotor under `moveByVelocityZ` at z = −20 m, as `./skein identify` fits it to live
    * flights of the paper's duel: gain ± 0.017, lag ± 0.07 s, dead time ± 0.02 s (95 %). Off the full
    * quadrotor by 0.02 m after 1 s and 0.22 m after 5 s (medians). See [[skein.vehicle.ReducedModel.AirSim]],
    * which follows it more closely.
    */
  val AirSim: Reduced = Reduced(gain = 0.919, lagS = 2.66, deadTimeS = 0.053)

/** Integrates [[Reduced]] exactly between the times at which commands begin to act. */
private[skein] final class LagVehicle(model: Reduced) extends Vehicle:
  var x, y, vx, vy             = 0.0
  private var now, down        = 0.0
  private var wantedX, wantedY = 0.0
  private val coming           = DeadTime(model.deadTimeS)

  def start(x0: Double, y0: Double, z: Double): Unit =
    x = x0; y = y0; vx = 0; vy = 0; down = z
    now = 0; wantedX = 0; wantedY = 0
    coming.clear()

  def command(commandedX: Double, commandedY: Double): Unit =
    coming.put(now, model.gain * commandedX, model.gain * commandedY)

  def advance(timeS: Double): Unit =
    coming.until(timeS): (atS, vxWanted, vyWanted) =>
      glide(atS)
      wantedX = vxWanted; wantedY = vyWanted
    glide(timeS)

  override def seen: Kinematics = level(down)

  private def glide(until: Double): Unit =
    val dt      = until - now
    val stays   = model.lag.remains(dt)
    val carries = model.lag.carriedS(stays)
    x += wantedX * dt + (vx - wantedX) * carries
    y += wantedY * dt + (vy - wantedY) * carries
    vx = wantedX + (vx - wantedX) * stays
    vy = wantedY + (vy - wantedY) * stays
    now = until
