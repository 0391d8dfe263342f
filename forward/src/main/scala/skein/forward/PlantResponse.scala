package skein.forward

import skein.signal.Kinematics
import skein.vehicle.{ConstantVelocity, Plant, VehicleModel}

/** Forward simulation by a [[skein.vehicle.Plant]]. */
final case class PlantResponse(plant: Plant[?]) extends VelocityResponse:
  require(plant.stepS > 0, s"a plant's step must be positive, came ${plant.stepS} s")
  require(plant.deadTimeS >= 0, s"a plant's dead time must not be negative, came ${plant.deadTimeS} s")

  def create(): Vehicle = PlantVehicle(plant)

  override def predictor: VehicleModel[?] = ConstantVelocity

private[skein] final class PlantVehicle[S](plant: Plant[S]) extends Vehicle:
  private val coming               = DeadTime(plant.deadTimeS)
  private var state                = plant.initial // when the present step began
  private var reading              = plant.read(state)
  private var stepAtS, nowS        = 0.0
  private var wantedX, wantedY     = 0.0
  private var startX, startY, down = 0.0
  private var isCommanded          = false

  def start(x: Double, y: Double, z: Double): Unit =
    startX = x; startY = y; down = z
    state = plant.initial
    reading = plant.read(state)
    nowS = 0; isCommanded = false
    coming.clear()

  def command(vx: Double, vy: Double): Unit = coming.put(nowS, vx, vy)

  def advance(timeS: Double): Unit =
    coming.until(timeS): (atS, vx, vy) =>
      state = flown(atS)
      stepAtS = atS; wantedX = vx; wantedY = vy; isCommanded = true
    reading = plant.read(flown(timeS))
    nowS = timeS

  private def flown(untilS: Double): S =
    if isCommanded then
      while untilS > stepAtS + plant.stepS do
        state = plant.step(state, wantedX, wantedY, plant.stepS)
        stepAtS += plant.stepS
    if isCommanded && untilS > stepAtS then plant.step(state, wantedX, wantedY, untilS - stepAtS) else state

  def x: Double  = startX + reading.northM
  def y: Double  = startY + reading.eastM
  def vx: Double = reading.northMps
  def vy: Double = reading.eastMps

  override def seen: Kinematics = level(down)
