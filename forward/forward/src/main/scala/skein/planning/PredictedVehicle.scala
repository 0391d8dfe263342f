package skein.planning

import skein.vehicle.{ObservedPlant, PlaneReading, Plant, PlantState, ReducedModel}

/** A vehicle's state, with the plant that predicts it.
  *
  * @param plant by which it moves; its dead time has no effect here
  * @param northM origin of its plant, m, world NED
  * @param carriesS time for which its last velocity carries it without further commands, s: for a first-order
  *   lag, the lag
  */
final case class PredictedVehicle[S](
    plant: Plant[S],
    state: S,
    northM: Double,
    eastM: Double,
    carriesS: Double
):
  /** Its position and velocity: m and m/s, world NED. */
  def motion: PlaneReading =
    val read = plant.read(state)
    read.copy(northM = northM + read.northM, eastM = eastM + read.eastM)

  /** The vehicle with another origin of its plant. */
  def moved(northM: Double, eastM: Double): PredictedVehicle[S] =
    copy(northM = this.northM + northM, eastM = this.eastM + eastM)

  /** The vehicle after a commanded velocity has lasted for this time. */
  def flown(northMps: Double, eastMps: Double, dtS: Double): PredictedVehicle[S] =
    val pieces = PredictedVehicle.pieces(plant, dtS)
    var now    = state
    var piece  = 0
    while piece < pieces do
      now = plant.step(now, northMps, eastMps, dtS / pieces)
      piece += 1
    copy(state = now)

object PredictedVehicle:
  /** Time after which a vehicle with a command to stand still counts as standing, s. */
  private val StandsWithinS = 10.0

  def apply(model: ReducedModel, at: PlaneReading): PredictedVehicle[PlaneReading] =
    of(model, at, model.lagS)

  /** A vehicle from its reading.
    *
    * @param state of its plant as numbers, if the reading does not contain the whole state; else empty
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

  /** Time for which a plant's velocity carries it: its stopping distance over its speed before, m/s. */
  def carriesS(plant: ObservedPlant[?], speedMps: Double): Double = plant match
    case model: ReducedModel => model.lagS
    case _                   =>
      val still = of(plant, PlaneReading(0, 0, speedMps, 0), 0).flown(0, 0, StandsWithinS).motion
      StrictMath.hypot(still.northM, still.eastM) / speedMps

  /** Number of the plant's steps within this time, none longer than its limit. */
  private[planning] def pieces(plant: Plant[?], dtS: Double): Int =
    math.ceil(dtS / plant.stepS - 1e-9).toInt.max(1)
