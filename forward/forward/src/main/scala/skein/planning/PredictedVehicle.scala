package skein.planning

import skein.units.eachBelow
import skein.vehicle.{ObservedPlant, PlaneReading, Plant, PlantState, ReducedModel}

/** A vehicle's state, with the plant that predicts it.
  *
  * @param plant predicts the vehicle; its dead time has no effect here
  * @param northM north component of the plant's origin, m, world NED
  * @param carriesS time for which the last velocity carries the vehicle without further commands, s; for a
  *   first-order lag, the lag
  */
final case class PredictedVehicle[S](
    plant: Plant[S],
    state: S,
    northM: Double,
    eastM: Double,
    carriesS: Double
):
  /** The vehicle's position, m, and velocity, m/s, world NED. */
  def motion: PlaneReading =
    val read = plant.read(state)
    read.copy(northM = northM + read.northM, eastM = eastM + read.eastM)

  /** The vehicle, moved by this distance, m north and east. */
  def moved(northM: Double, eastM: Double): PredictedVehicle[S] =
    copy(northM = this.northM + northM, eastM = this.eastM + eastM)

  /** The vehicle after a commanded velocity has been in effect for this time. */
  def flown(northMps: Double, eastMps: Double, dtS: Double): PredictedVehicle[S] =
    val pieces = PredictedVehicle.pieces(plant, dtS)
    var now    = state
    eachBelow(pieces): _ =>
      now = plant.step(now, northMps, eastMps, dtS / pieces)
    copy(state = now)

object PredictedVehicle:
  /** Time after which a vehicle that is commanded to stand still is assumed to stand, s. */
  private val StandsWithinS = 10.0

  def apply(model: ReducedModel, at: PlaneReading): PredictedVehicle[PlaneReading] =
    of(model, at, model.lagS)

  /** Creates a vehicle from its reading.
    *
    * @param state the components of the plant's state if the reading lacks a part of it; else empty
    */
  def of[S](
      plant: ObservedPlant[S],
      at: PlaneReading,
      carriesS: Double,
      state: Vector[Double] = Vector.empty
  ): PredictedVehicle[S] =
    val held = if state.isEmpty then plant.initial else PlantState.of(plant.initial, state)
    PredictedVehicle(
      plant,
      plant.corrected(held, at.copy(northM = 0, eastM = 0)),
      at.northM,
      at.eastM,
      carriesS
    )

  /** Time for which a plant's velocity carries the vehicle, s: its stopping distance divided by its speed. */
  def carriesS(plant: ObservedPlant[?], speedMps: Double): Double = plant match
    case model: ReducedModel => model.lagS
    case _                   =>
      val still = of(plant, PlaneReading(0, 0, speedMps, 0), 0).flown(0, 0, StandsWithinS).motion
      StrictMath.hypot(still.northM, still.eastM) / speedMps

  /** Number of equal steps of the plant within this time, none longer than the plant's limit. */
  private[planning] def pieces(plant: Plant[?], dtS: Double): Int =
    math.ceil(dtS / plant.stepS - 1e-9).toInt.max(1)
