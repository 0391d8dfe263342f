package skein.planning

import skein.vehicle.{PlaneReading, Plant, ReducedModel}

/** A vehicle, and how it will move.
  *
  * @param plant by which it moves; its dead time has no effect here
  * @param northM where its plant counts from, m, world NED
  * @param carriesS for so long its last velocity carries it on, if nothing more is commanded, s: for a
  *   first-order lag, the lag
  */
final case class PredictedVehicle[S](
    plant: Plant[S],
    state: S,
    northM: Double,
    eastM: Double,
    carriesS: Double
):
  /** Where it is, and how fast: m and m/s, world NED. */
  def motion: PlaneReading =
    val read = plant.read(state)
    read.copy(northM = northM + read.northM, eastM = eastM + read.eastM)

  /** The same elsewhere. */
  def moved(northM: Double, eastM: Double): PredictedVehicle[S] =
    copy(northM = this.northM + northM, eastM = this.eastM + eastM)

  /** After a commanded velocity has stood for so long. */
  def flown(northMps: Double, eastMps: Double, dtS: Double): PredictedVehicle[S] =
    val pieces = PredictedVehicle.pieces(plant, dtS)
    var now    = state
    var piece  = 0
    while piece < pieces do
      now = plant.step(now, northMps, eastMps, dtS / pieces)
      piece += 1
    copy(state = now)

object PredictedVehicle:
  def apply(model: ReducedModel, at: PlaneReading): PredictedVehicle[PlaneReading] =
    PredictedVehicle(model, at.copy(northM = 0, eastM = 0), at.northM, at.eastM, model.lagS)

  /** Of a plan's step, none longer than the plant's. */
  private[planning] def pieces(plant: Plant[?], dtS: Double): Int =
    math.ceil(dtS / plant.stepS - 1e-9).toInt.max(1)
