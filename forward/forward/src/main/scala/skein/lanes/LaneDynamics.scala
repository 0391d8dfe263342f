package skein.lanes

import skein.forward.{
  CarResponse,
  RolloutAgent,
  LoopTiming,
  Nanos,
  PlantResponse,
  QuadrotorResponse,
  SensedResponse,
  SpatialResponse,
  TeamResponses,
  VelocityResponse
}
import skein.lanes.loop.{LagVehicles, LanePredictor, LaneVehicles, LoopLanes, PlantFlights}
import skein.lanes.plant.{LaneQuadrotors, PlantLanes, QuadrotorLanes}
import skein.lanes.timetable.{
  EventClock,
  StepClock,
  TimetableDynamics,
  TimetablePlants,
  TimetableQuadrotors,
  TimetableVehicles
}
import skein.units.Expect
import skein.vehicle.{ReducedModel, SensorNoise}

/** Simulates a kind of vehicle with SIMD: with [[skein.lanes.timetable.Timetable]]s and, if it
  * [[fliesAlone]], also with separate delays in every world.
  */
private[skein] trait LaneDynamics extends TimetableDynamics:
  /** Maximum duration of one simulation step, s. */
  def stepS: Double

  /** Whether a flight consists of closed-form pieces, so that the vehicle can be read at any recent moment.
    */
  def fliesAlone: Boolean = true

  /** Whether policies must keep the altitude of the vehicle's start. */
  def fliesLevel: Boolean = false

  override def predictor: Option[LanePredictor] = None

  /** The vehicles of one role in all worlds, whose commands take effect at different times. */
  private[lanes] def flights(agent: RolloutAgent, loop: LoopLanes): LaneVehicles

private[skein] object LaneDynamics:
  /** The dynamics of a model; Left says why SIMD does not support it.
    *
    * @param inSpace whether commands and readings of the team have a vertical part
    */
  def of(model: VelocityResponse, inSpace: Boolean = false): Either[String, LaneDynamics] = model match
    case quadrotor: QuadrotorResponse =>
      QuadrotorLanes.of(quadrotor.quadrotor).map(QuadrotorDynamics(quadrotor, _))
    case PlantResponse(plant)      => PlantLanes.of(plant).map(PlantDynamics(_, inSpace, fliesLevel = true))
    case SpatialResponse(plant, _) => PlantLanes.of(plant).map(PlantDynamics(_, true, fliesLevel = false))
    case car: CarResponse => PlantLanes.of(car.plant).map(PlantDynamics(_, inSpace, fliesLevel = false))
    case SensedResponse(of, noise) => this.of(of, inSpace).map(SensedDynamics(_, noise))
    case _                         => Left("SIMD does not support the vehicle")

  /** The dynamics of a model under a loop; if the loop predicts, SIMD must support its predictor too.
    *
    * @return Left says why SIMD does not support it
    */
  def under(
      timing: LoopTiming,
      model: VelocityResponse,
      inSpace: Boolean = false
  ): Either[String, LaneDynamics] =
    of(model, inSpace).flatMap: vehicles =>
      timing match
        case predictive: LoopTiming.Predictive =>
          for
            predictor <- LanePredictor.of(model.predictorUnder(predictive.predictor))
            _         <- Expect.that(predictor.inSpace == model.body.isInstanceOf[SpatialResponse]):
              "SIMD predicts climbs by a model in space, and level flight by another"
          yield PredictedDynamics(vehicles, predictor)
        case _ => Right(vehicles)

  /** Checks that all vehicles start high enough. Left says why SIMD does not support their start. */
  def isHighEnough(model: VelocityResponse, vehicles: Vector[RolloutAgent]): Either[String, Unit] =
    val startsM = TeamResponses.of(vehicles, model.body).zip(vehicles).collect:
      case (_: QuadrotorResponse, agent) => -agent.altitudeDownM
    Expect.that(startsM.forall(_ >= LeastAltitudeM)):
      s"SIMD simulates no ground: vehicles must start at $LeastAltitudeM m altitude or higher"

  /** Minimum altitude of the start, m: AirSim's quadrotor loses height while it turns. */
  private val LeastAltitudeM = 5.0

/** Adds a loop's predictions to the dynamics of vehicles. */
private final class PredictedDynamics(model: LaneDynamics, by: LanePredictor) extends LaneDynamics:
  export model.{clock, deadTimeS, flights, handoverS, stepS}
  override def sensors: Option[SensorNoise]            = model.sensors
  override def fliesAlone: Boolean                     = model.fliesAlone
  override def fliesLevel: Boolean                     = model.fliesLevel
  override def predictor: Option[LanePredictor]        = Some(by)
  def vehicles(agent: RolloutAgent): TimetableVehicles =
    val flown = model.vehicles(agent)
    flown.predicted = by.vehicles(agent)
    flown

/** Adds errors to the readings of vehicles with these dynamics. */
private final class SensedDynamics(model: LaneDynamics, noise: SensorNoise) extends LaneDynamics:
  export model.{clock, deadTimeS, handoverS, stepS}
  override def fliesAlone: Boolean                     = model.fliesAlone
  override def fliesLevel: Boolean                     = model.fliesLevel
  override def sensors: Option[SensorNoise]            = Some(noise)
  def vehicles(agent: RolloutAgent): TimetableVehicles =
    val flown = model.vehicles(agent)
    flown.senseBy(noise)
    flown

  private[lanes] def flights(agent: RolloutAgent, loop: LoopLanes): LaneVehicles =
    val flown = model.flights(agent, loop)
    flown.senseBy(noise, loop.periodS)
    flown

/** Dynamics by [[TimetablePlants]] and [[PlantFlights]]; a simple lag may also use [[LagVehicles]].
  *
  * @param inSpace whether commands and readings have a vertical part, even if the plant has none
  */
private final class PlantDynamics(lanes: PlantLanes, inSpace: Boolean, override val fliesLevel: Boolean)
    extends LaneDynamics:
  def stepS: Double                                    = lanes.plant.stepS
  def deadTimeS: Double                                = lanes.plant.deadTimeS
  def handoverS: Double                                = 0
  def vehicles(agent: RolloutAgent): TimetableVehicles = TimetablePlants(agent, lanes, inSpace)

  def clock(): EventClock = StepClock(lanes, lanes.stages.tell(lanes.plant))

  private[lanes] def flights(agent: RolloutAgent, loop: LoopLanes): LaneVehicles =
    (lanes.plant, loop.timing) match
      // If hardly any reading is from an earlier period, LagVehicles is faster.
      case (lag: ReducedModel, stream: LoopTiming.Stream)
          if lag.isLag && !loop.sees && stream.periodS >= PlantDynamics.LeastPeriodS &&
            LagVehicles.canFly(lag, loop.longestS) =>
        val earliestS = stream.asking.timeoutS + stream.patienceS + stream.periodS
        LagVehicles(agent, lag, stream.periodS, loop.longestS, earliestS)
      case _ => PlantFlights(agent, lanes, loop, inSpace)

private object PlantDynamics:
  /** Shortest period for [[LagVehicles]], s; below it, too many commands are pending. */
  private val LeastPeriodS = 0.02

/** Dynamics by [[TimetableQuadrotors]]. A time is represented by the number of steps since the last event,
  * and by the time since the last step.
  */
private final class QuadrotorDynamics(model: QuadrotorResponse, lanes: QuadrotorLanes) extends LaneDynamics:
  private val stepNs    = Nanos.of(model.quadrotor.stepS)
  private val hoveredNs = Nanos.of(model.hoveredS)

  def stepS: Double                                    = model.quadrotor.stepS
  def deadTimeS: Double                                = 0
  def handoverS: Double                                = model.handoverS
  def vehicles(agent: RolloutAgent): TimetableVehicles = TimetableQuadrotors(agent, LaneQuadrotors(lanes))

  override def fliesAlone: Boolean                                               = false
  override def fliesLevel: Boolean                                               = true
  private[lanes] def flights(agent: RolloutAgent, loop: LoopLanes): LaneVehicles =
    throw UnsupportedOperationException(
      "quadrotors of worlds with delays of their own fly by SteppedRollouts"
    )

  def clock(): EventClock = new EventClock:
    private var steps                                                       = hoveredNs / stepNs
    def numbers: Int                                                        = 2
    def tell(atS: Double, acts: Boolean, into: Array[Float], at: Int): Unit =
      val now   = hoveredNs + Nanos.of(atS)
      val flown = now / stepNs
      into(at) = (flown - steps).toFloat
      into(at + 1) = ((now - flown * stepNs) * 1e-9).toFloat
      steps = flown
