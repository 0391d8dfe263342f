package skein.loop

import skein.planning.{Planner, PredictedVehicle}
import skein.policy.Agent
import skein.vehicle.*
import scala.util.Try

/** A plan's prediction of one vehicle: by the plant that predicts its readings.
  *
  * @param carriesS see [[PredictedVehicle.carriesS]]
  */
private final class ForeseenVehicle(val plant: ObservedPlant[?], carriesS: Double):

  def at(view: TeamView, vehicle: Int): PredictedVehicle[?] =
    val state = view.estimates.fold(Vector.empty)(_(vehicle).state)
    PredictedVehicle.of(plant, PlantModel.readingOf(view.kinematics(vehicle)), carriesS, state)

private object ForeseenVehicle:
  /** Replaces speeds of 0, m/s, to avoid a division by zero. */
  private val LeastMps = 0.1

  /** Chooses the plant for a vehicle.
    *
    * @param model the model that predicts its readings. For a model without a plant of velocities, plans use
    *   AirSim's quadrotor at the vehicle's altitude
    * @return Left says why planning does not support it
    */
  def of(agent: Agent, model: VehicleModel[?], settings: PlanSettings): Either[String, ForeseenVehicle] =
    val plant = model match
      case PlantModel(plant) => Right(plant)
      case _: (QuadrotorModel | CarModel) | AdaptiveQuadrotor | ConstantVelocity | ConstantTurn => Right(
          ReducedModel.airSimAt(settings.altitudeM(-agent.startPositionNed.z))
        )
      case other => Left(s"expected a model of a plant (skein.vehicle.PlantModel) to plan by, got $other")
    val known =
      for
        plant <- plant
        _     <- Planner.refusal(plant).map("plans are flown with SIMD, and " + _).toLeft(())
        rest = plant.initial
        _ <- Try(PlantState.of(rest, PlantState.numbers(rest))).toEither.left.map(_.getMessage)
      yield ForeseenVehicle(plant, PredictedVehicle.carriesS(plant, agent.speed.value.max(LeastMps)))
    known.left.map(reason => s"${agent.name}: $reason")
