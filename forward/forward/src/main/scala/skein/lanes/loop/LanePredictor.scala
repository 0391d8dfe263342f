package skein.lanes.loop

import skein.forward.RolloutAgent
import skein.lanes.plant.{PlantCorrection, PlantLanes}
import skein.lanes.timetable.{
  CommandPropagator,
  PredictedLagVehicles,
  PredictedPlants,
  PredictedVehicles,
  Propagation,
  Propagator,
  StepClock,
  TimetablePredictor
}
import skein.vehicle.{
  ConstantVelocity,
  FirstOrderLag,
  PlantModel,
  PlantTiming,
  ReducedModel,
  SpatialModel,
  VehicleModel
}

/** A kind of model whose predictions SIMD supports. */
private[skein] trait LanePredictor extends TimetablePredictor:
  /** Whether it predicts climbs. */
  def inSpace: Boolean = false

  /** The predictions of one vehicle in all worlds, with separate delays in every world. */
  def alone(agent: RolloutAgent): ForecastVehicles

private[skein] object LanePredictor:
  /** The predictor of a model; Left says why SIMD does not support it. */
  def of(model: VehicleModel[?]): Either[String, LanePredictor] = model match
    case PlantModel(lag: ReducedModel) if lag.isLag => Right(LagPredictor(lag))
    case PlantModel(plant)                          => byPlant(plant)
    case SpatialModel(plant)                        => byPlant(plant)
    case ConstantVelocity                           => Right(CoastPredictor)
    case _ => Left("SIMD predicts by plants and by constant velocity")

  private def byPlant(plant: PlantTiming) =
    for
      lanes      <- PlantLanes.of(plant)
      correction <- PlantCorrection.of(plant, lanes.count)
    yield PlantPredictor(lanes, correction)

/** Predicts constant velocity, by [[PredictedLagVehicles]]. */
private[lanes] object CoastPredictor extends LanePredictor, Propagator:
  def vehicles(agent: RolloutAgent): PredictedVehicles     = PredictedLagVehicles(0)
  def alone(agent: RolloutAgent): ForecastVehicles         = ForecastCoasting()
  def deadTimeS: Double                                    = 0
  def propagator: Propagator                               = this
  def next(legs: Vector[Propagator.Leg]): Propagator       = this
  def predicted(legs: Vector[Propagator.Leg]): Propagation =
    Propagation(Array.empty, Array.empty, legs.iterator.map(_.span.toSeconds).sum.toFloat, 1)

/** Predicts a first-order lag, by [[PredictedLagVehicles]] with these factors: for a reading, the time for
  * which its velocity moves the vehicle, and the fraction of that velocity that remains; for each command,
  * the time for which it moves the vehicle, and the fraction of its velocity that is reached.
  */
private[lanes] final class LagPredictor(val model: ReducedModel) extends LanePredictor:
  def deadTimeS: Double                                = model.deadTimeS
  def vehicles(agent: RolloutAgent): PredictedVehicles = PredictedLagVehicles(agent.speed * model.gain)
  def alone(agent: RolloutAgent): ForecastVehicles = ForecastLagVehicles(agent.speed * model.gain, model.lagS)

  def propagator: Propagator = CommandPropagator(model.deadTimeS, propagation)

  private def propagation(flown: Vector[CommandPropagator.Flown], totalS: Double): Propagation =
    val lag = FirstOrderLag(model.lagS)
    CommandPropagator.told(flown, perPart = 2, lag.carriesS(totalS), lag.remains(totalS)): (part, into, at) =>
      val (left, after)               = (totalS - part.fromS, totalS - part.untilS)
      val (carriedLeft, carriedAfter) = (lag.carriesS(left), lag.carriesS(after))
      into(at) = ((left - carriedLeft) - (after - carriedAfter)).toFloat
      into(at + 1) = (carriedLeft / model.lagS - carriedAfter / model.lagS).toFloat

/** Predicts by compiled code of the plant's own step, [[PredictedPlants]]. */
private[lanes] final class PlantPredictor(val lanes: PlantLanes, val correction: PlantCorrection)
    extends LanePredictor:
  private val tell = lanes.stages.tell(lanes.plant)

  override def inSpace: Boolean                        = lanes.inSpace
  override def remembers: Boolean                      = !correction.isTold || inSpace
  def deadTimeS: Double                                = lanes.plant.deadTimeS
  def vehicles(agent: RolloutAgent): PredictedVehicles = PredictedPlants(lanes, correction, agent.speed)
  def alone(agent: RolloutAgent): ForecastVehicles     = ForecastPlants(lanes, correction, agent.speed)

  def propagator: Propagator =
    CommandPropagator(lanes.plant.deadTimeS, (flown, _) => propagation(flown))

  private def propagation(flown: Vector[CommandPropagator.Flown]): Propagation =
    CommandPropagator.told(flown, StepClock.numbers(lanes)): (part, into, at) =>
      StepClock(lanes, tell, part.fromS).tell(part.untilS, acts = false, into, at)
