package skein.lanes

import skein.forward.{
  Duel,
  RolloutAgent,
  LoopTiming,
  Nanos,
  PlantResponse,
  QuadrotorResponse,
  VelocityResponse
}
import skein.lanes.loop.{LagVehicles, LanePredictor, LaneVehicles, LoopLanes, PlantFlights}
import skein.lanes.plant.{LaneQuadrotors, PlantLanes, QuadrotorLanes}
import skein.lanes.timetable.{
  EventClock,
  StepClock,
  TimetableDynamics,
  TimetablePlants,
  TimetablePredictor,
  TimetableQuadrotors,
  TimetableVehicles
}
import skein.units.Expect
import skein.vehicle.ReducedModel

/** How a kind of vehicle flies by lanes: by [[skein.lanes.timetable.Timetable]]s and, if it [[fliesAlone]],
  * where every world has delays of its own.
  */
private[skein] trait LaneDynamics extends TimetableDynamics:
  /** How long one of its steps lasts at most, s. */
  def stepS: Double

  /** Whether its flight is known in pieces, from which it can be read at any moment of the near past. */
  def fliesAlone: Boolean = true

  /** All worlds' vehicles of one role, whose commands act at times of their own. */
  private[lanes] def flights(agent: RolloutAgent, loop: LoopLanes): LaneVehicles

private[skein] object LaneDynamics:
  /** @return or why this model does not fly by lanes
    */
  def of(model: VelocityResponse, duel: Duel): Either[String, LaneDynamics] =
    of(model, Seq(duel.pursuer, duel.evader))

  /** @return or why these do not fly by lanes with this model
    */
  def of(model: VelocityResponse, vehicles: Seq[RolloutAgent]): Either[String, LaneDynamics] = model match
    case quadrotor: QuadrotorResponse =>
      val lowest = -vehicles.map(_.altitudeDownM).max
      for
        _ <- Expect.that(lowest >= LeastAltitudeM):
          s"the lanes know no ground and fly from $LeastAltitudeM m altitude on"
        lanes <- QuadrotorLanes.of(quadrotor.quadrotor)
      yield QuadrotorDynamics(quadrotor, lanes)
    case PlantResponse(plant) => PlantLanes.of(plant).map(PlantDynamics(_))
    case _                    => Left("the lanes do not know the vehicle")

  /** Vehicles of this model under a loop: if that predicts, what it predicts by flies by lanes too.
    *
    * @return or why not
    */
  def under(timing: LoopTiming, model: VelocityResponse, duel: Duel): Either[String, LaneDynamics] =
    under(timing, model, Seq(duel.pursuer, duel.evader))

  /** @return or why these do not fly by lanes under the loop with this model
    */
  def under(
      timing: LoopTiming,
      model: VelocityResponse,
      vehicles: Seq[RolloutAgent]
  ): Either[String, LaneDynamics] =
    of(model, vehicles).flatMap: vehicles =>
      timing match
        case predictive: LoopTiming.Predictive =>
          LanePredictor.of(predictive.predictor).map(PredictedDynamics(vehicles, _))
        case _ => Right(vehicles)

  /** AirSim's quadrotor loses height while it turns. */
  private val LeastAltitudeM = 5.0

/** Vehicles whose readings are carried forward. */
private final class PredictedDynamics(model: LaneDynamics, by: TimetablePredictor) extends LaneDynamics:
  export model.{clock, deadTimeS, flights, handoverS, stepS}
  override def fliesAlone: Boolean                     = model.fliesAlone
  override def predictor: Option[TimetablePredictor]   = Some(by)
  def vehicles(agent: RolloutAgent): TimetableVehicles =
    val flown = model.vehicles(agent)
    flown.predicted = by.vehicles(agent)
    flown

/** By [[TimetablePlants]] and [[PlantFlights]]; a lag alone also by [[LagVehicles]]. */
private final class PlantDynamics(lanes: PlantLanes) extends LaneDynamics:
  def stepS: Double                                    = lanes.plant.stepS
  def deadTimeS: Double                                = lanes.plant.deadTimeS
  def handoverS: Double                                = 0
  def vehicles(agent: RolloutAgent): TimetableVehicles = TimetablePlants(agent, lanes)

  def clock(): EventClock = StepClock(lanes, lanes.stages.tell(lanes.plant))

  private[lanes] def flights(agent: RolloutAgent, loop: LoopLanes): LaneVehicles =
    (lanes.plant, loop.timing) match
      // Where hardly a reading is of a period before, the way of a lag alone is the faster one.
      case (lag: ReducedModel, stream: LoopTiming.Stream)
          if lag.isLag && !loop.sees && stream.periodS >= PlantDynamics.LeastPeriodS &&
            LagVehicles.canFly(lag, loop.longestS) =>
        val earliestS = stream.asking.timeoutS + stream.patienceS + stream.periodS
        LagVehicles(agent, lag, stream.periodS, loop.longestS, earliestS)
      case _ => PlantFlights(agent, lanes, loop)

private object PlantDynamics:
  /** Below, too many periods' commands are under way for [[LagVehicles]]. */
  private val LeastPeriodS = 0.02

/** By [[TimetableQuadrotors]]: how many steps there are until then, and the time since the last. */
private final class QuadrotorDynamics(model: QuadrotorResponse, lanes: QuadrotorLanes) extends LaneDynamics:
  private val stepNs    = Nanos.of(model.quadrotor.stepS)
  private val hoveredNs = Nanos.of(model.hoveredS)

  def stepS: Double                                    = model.quadrotor.stepS
  def deadTimeS: Double                                = 0
  def handoverS: Double                                = model.handoverS
  def vehicles(agent: RolloutAgent): TimetableVehicles = TimetableQuadrotors(agent, LaneQuadrotors(lanes))

  override def fliesAlone: Boolean                                               = false
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
