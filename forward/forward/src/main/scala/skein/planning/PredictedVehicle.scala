package skein.planning

import skein.vehicle.{ObservedPlant, PlaneReading, Plant, PlantState, ReducedModel}

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
  /** Within which a vehicle that is told to stand still is taken to do so, s. */
  private val StandsWithinS = 10.0

  def apply(model: ReducedModel, at: PlaneReading): PredictedVehicle[PlaneReading] =
    of(model, at, model.lagS)

  /** A vehicle by what is read of it.
    *
    * @param state of its plant as numbers, where the reading does not tell all of it; else empty
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

  /** For how long a plant's velocity carries it on: the way that it goes once it is told to stand still, over
    * its speed before, m/s.
    */
  def carriesS(plant: ObservedPlant[?], speedMps: Double): Double = plant match
    case model: ReducedModel => model.lagS
    case _                   =>
      val still = of(plant, PlaneReading(0, 0, speedMps, 0), 0).flown(0, 0, StandsWithinS).motion
      StrictMath.hypot(still.northM, still.eastM) / speedMps

  /** Of a plan's step, none longer than the plant's. */
  private[planning] def pieces(plant: Plant[?], dtS: Double): Int =
    math.ceil(dtS / plant.stepS - 1e-9).toInt.max(1)
