package skein.flight

import skein.forecast.Structure
import skein.policy.{Axis, SearchSpace}
import skein.scenario.Scenarios
import skein.settings.PredictionModel
import skein.vehicle.{ObservedPlant, PlaneReading}

/** Position, velocity and acceleration; readings lack the acceleration. */
final case class Tilted(seen: PlaneReading, northMps2: Double, eastMps2: Double)

/** Tilts before it accelerates: a user's own plant. */
final case class Tilting(gain: Double, lagS: Double, tiltLagS: Double) extends ObservedPlant[Tilted]:
  def initial: Tilted                                      = Tilted(PlaneReading(0, 0, 0, 0), 0, 0)
  def stepS: Double                                        = 0.05
  def read(state: Tilted): PlaneReading                    = state.seen
  def corrected(state: Tilted, seen: PlaneReading): Tilted = state.copy(seen = seen)

  def step(state: Tilted, northMps: Double, eastMps: Double, dtS: Double): Tilted =
    import state.seen
    val share = 1 - StrictMath.exp(-dtS / tiltLagS)
    val north = state.northMps2 + share * ((gain * northMps - seen.northMps) / lagS - state.northMps2)
    val east  = state.eastMps2 + share * ((gain * eastMps - seen.eastMps) / lagS - state.eastMps2)
    val moved = PlaneReading(
      seen.northM + seen.northMps * dtS,
      seen.eastM + seen.eastMps * dtS,
      seen.northMps + north * dtS,
      seen.eastMps + east * dtS
    )
    Tilted(moved, north, east)

object Tilting:
  val structure: Structure = Structure(
    "tilting",
    SearchSpace(Vector(Axis("lag-s", 0.1, 10), Axis("tilt-lag-s", 0.02, 2))),
    values => Tilting(1, values(0), values(1))
  )

  val predictor: PredictionModel = PredictionModel.Own(structure, Vector(2.9, 0.15))

  val scenarios: Scenarios = Scenarios.ours.copy(ownStructures = Vector(structure))
