package skein.lanes

import skein.forward.Duelist
import skein.units.Span
import skein.vehicle.{ConstantVelocity, FirstOrderLag, ReducedModel, PlantModel, VehicleModel}

/** A kind of model that carries readings forward by [[Timetable]]s. */
private[skein] trait TimetablePredictor:
  /** Of one vehicle at its first reading. */
  def propagator: Propagator

  /** All worlds' predictions of one vehicle. */
  def vehicles(duelist: Duelist): PredictedVehicles

  /** The same where every world has delays of its own. */
  def alone(duelist: Duelist): ForecastVehicles

  /** From a command's arrival until a vehicle is taken to follow it, s. */
  def deadTimeS: Double

/** Tells by which propagations a reading of one vehicle is carried forward. Immutable: it knows what the
  * model remembers at that reading.
  */
private[lanes] trait Propagator:
  /** That of the next reading, after these legs. */
  def next(legs: Vector[Propagator.Leg]): Propagator

  /** From the reading on through these legs. */
  def predicted(legs: Vector[Propagator.Leg]): Propagation

private[lanes] object Propagator:
  /** A [[skein.forecast.Leg]].
    *
    * @param decision that its command carries; 0: none was sent yet
    */
  final case class Leg(decision: Int, span: Span)

private[skein] object TimetablePredictor:
  /** Below, powers of e leave what floats hold. */
  val LeastLagS = 0.01

  /** @return or why this model does not predict by lanes
    */
  def of(model: VehicleModel[?]): Either[String, TimetablePredictor] = model match
    case PlantModel(lag: ReducedModel) if lag.dragPerM == 0 && lag.turnLagS == lag.lagS =>
      Right(LagPredictor(lag))
    case PlantModel(drag: ReducedModel) =>
      Either
        .cond(
          drag.lagS.min(drag.turnLagS) >= LeastLagS,
          drag,
          s"the lanes predict by models with lags of $LeastLagS s at least"
        )
        .flatMap(PlantLanes.of)
        .map(DragPredictor(_))
    case ConstantVelocity => Right(CoastPredictor)
    case _                => Left("the lanes predict by reduced models and constant velocity")

/** By [[PredictedLagVehicles]]: a reading's velocity carries the vehicle all the time. */
private[lanes] object CoastPredictor extends TimetablePredictor, Propagator:
  def vehicles(duelist: Duelist): PredictedVehicles        = PredictedLagVehicles(0)
  def alone(duelist: Duelist): ForecastVehicles            = ForecastCoasting()
  def deadTimeS: Double                                    = 0
  def propagator: Propagator                               = this
  def next(legs: Vector[Propagator.Leg]): Propagator       = this
  def predicted(legs: Vector[Propagator.Leg]): Propagation =
    Propagation(Array.empty, legs.iterator.map(_.span.toSeconds).sum, 1)

/** By [[PredictedLagVehicles]]: for how long a reading's velocity carries the vehicle, and what is left of
  * it; of each command, how long it carries the vehicle, and how much of its velocity is reached.
  */
private[lanes] final class LagPredictor(val model: ReducedModel) extends TimetablePredictor:
  def deadTimeS: Double                             = model.deadTimeS
  def vehicles(duelist: Duelist): PredictedVehicles = PredictedLagVehicles(duelist.speed * model.gain)
  def alone(duelist: Duelist): ForecastVehicles = ForecastLagVehicles(duelist.speed * model.gain, model.lagS)

  def propagator: Propagator = ReducedPropagator(model.deadTimeS, propagation)

  private def propagation(flown: Vector[ReducedPropagator.Flown], totalS: Double): Propagation =
    val lag   = FirstOrderLag(model.lagS)
    val parts = flown.map: part =>
      val (left, after)               = (totalS - part.fromS, totalS - part.untilS)
      val (carriedLeft, carriedAfter) = (lag.carriesS(left), lag.carriesS(after))
      val moved                       = (left - carriedLeft) - (after - carriedAfter)
      val reached                     = carriedLeft / model.lagS - carriedAfter / model.lagS
      Propagation.Part(part.decision, Array(moved.toFloat, reached.toFloat))
    Propagation(parts.toArray, lag.carriesS(totalS), lag.remains(totalS))

/** By [[PredictedPlants]]. */
private[lanes] final class DragPredictor(val lanes: PlantLanes) extends TimetablePredictor:
  private val tell = lanes.stages.tell(lanes.plant)

  def deadTimeS: Double                             = lanes.plant.deadTimeS
  def vehicles(duelist: Duelist): PredictedVehicles = PredictedPlants(lanes, duelist.speed)
  def alone(duelist: Duelist): ForecastVehicles     = ForecastPlants(lanes, duelist.speed)

  def propagator: Propagator =
    ReducedPropagator(lanes.plant.deadTimeS, (flown, _) => Propagation(flown.map(pieces).toArray))

  private def pieces(part: ReducedPropagator.Flown): Propagation.Part =
    val clock   = PieceClock(lanes, tell, part.fromS)
    val numbers = Array.ofDim[Float](clock.numbers)
    clock.tell(part.untilS, acts = false, numbers, 0)
    Propagation.Part(part.decision, numbers)

/** Which command acts when, as [[PlantModel]] takes it: each a dead time after it has come. A command that
  * repeats the one before is a new one here, and nothing there: with drag a piece more begins.
  *
  * @param propagation of what is flown, and until when, s from the reading
  */
private final class ReducedPropagator private (
    deadTime: Span,
    propagation: (Vector[ReducedPropagator.Flown], Double) => Propagation,
    held: ReducedPropagator.Known
) extends Propagator:
  import ReducedPropagator.*

  def next(legs: Vector[Propagator.Leg]): Propagator =
    new ReducedPropagator(deadTime, propagation, legs.foldLeft(held)(_.through(_, deadTime)._2))

  def predicted(legs: Vector[Propagator.Leg]): Propagation =
    val flown  = Vector.newBuilder[Flown]
    var known  = held
    var startS = 0.0
    for leg <- legs do
      val (due, after)        = known.through(leg, deadTime)
      val endS                = startS + leg.span.toSeconds
      var acting              = known.acting
      var fromS               = startS
      def fly(untilS: Double) = if untilS > fromS then flown += Flown(acting, fromS, untilS)
      for (decision, in) <- due do
        val actsS = startS + in.toSeconds
        fly(actsS)
        acting = decision
        fromS = actsS
      fly(endS)
      known = after
      startS = endS
    propagation(flown.result(), startS)

private object ReducedPropagator:
  def apply(deadTimeS: Double, propagation: (Vector[Flown], Double) => Propagation): Propagator =
    new ReducedPropagator(Span.ofSeconds(deadTimeS), propagation, Known(0, 0, Vector.empty))

  /** Under which decision's command the model flies from when until when, s from the reading. */
  final case class Flown(decision: Int, fromS: Double, untilS: Double)

  /** What [[PlantModel.Flying]] knows of commands, by their decisions.
    *
    * @param coming and in how long each acts
    */
  final case class Known(acting: Int, last: Int, coming: Vector[(Int, Span)]):
    /** What acts within a leg, and in how long, and what is known behind it. Whoever came first acts first.
      */
    def through(leg: Propagator.Leg, deadTime: Span): (Vector[(Int, Span)], Known) =
      val now            = if leg.decision == last then coming else coming :+ (leg.decision, deadTime)
      val (due, waiting) = now.span(_._2 <= leg.span)
      val behind         = waiting.map((decision, in) => (decision, in - leg.span))
      (due, Known(due.lastOption.fold(acting)(_._1), leg.decision, behind))
