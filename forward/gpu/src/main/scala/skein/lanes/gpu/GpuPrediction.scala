package skein.lanes.gpu

import skein.forward.{RolloutAgent, LoopTiming}
import skein.gpu.{Ptx, Variables}
import skein.lanes.loop.{CoastPredictor, LagPredictor, LanePredictor, PlantPredictor}
import skein.lanes.plant.PlantLanes
import skein.lanes.timetable.Propagation

/** Predicts one vehicle from its readings in the world of each thread, command by command; see
  * [[skein.lanes.timetable.PredictedVehicles]]. Variables contain the predicted position and velocity.
  */
private[lanes] trait GpuPrediction:
  /** Begins a prediction at a reading.
    *
    * @param reading registers of position and velocity, north and east
    */
  def begin(now: GpuRecord, reading: Vector[Int]): Unit

  /** Predicts the time under one command.
    *
    * @param north register of the command's component north, divided by the vehicle's speed
    */
  def go(now: GpuRecord, north: Int, east: Int): Unit

  /** Ends the prediction; returns the registers of predicted position and velocity. */
  def end(now: GpuRecord): Vector[Int]

private[lanes] object GpuPrediction:
  type Kind = (Ptx, RolloutAgent) => GpuPrediction

  /** The kind of prediction that a loop needs; None for a loop that does not predict.
    *
    * @return Left says why the GPU does not support it
    */
  def of(timing: LoopTiming): Either[String, Option[Kind]] = timing match
    case predictive: LoopTiming.Predictive =>
      LanePredictor.of(predictive.predictor).flatMap:
        case CoastPredictor    => Right(Some(GpuLagPrediction(_, _, 0)))
        case lag: LagPredictor => Right(Some(GpuLagPrediction(_, _, lag.model.gain)))
        case plant: PlantPredictor if plant.correction.isReading =>
          Right(Some(GpuPlantPrediction(_, _, plant.lanes)))
        case _ => Left("the GPU does not know what the loop predicts by")
    case _ => Right(None)

  /** Largest number of values in a record of this propagation. */
  def mostNumbers(of: Propagation): Int =
    2.max(2 * of.perPart)

  /** Writes the values of a propagation's first record. */
  def tellBegin(of: Propagation, tell: (Int, Float) => Unit): Unit =
    tell(0, of.first)
    tell(1, of.second)

  /** Writes the values of a part, and those of the end of the previous part, from which a plant continues.
    */
  def tellPart(of: Propagation, part: Int, tell: (Int, Float) => Unit): Unit =
    for i <- 0 until of.perPart do tell(i, of.numbers(part * of.perPart + i))
    if part > 0 then tellTime(of, part - 1, of.perPart, tell)

  /** Writes the values of the end of the last part. */
  def tellEnd(of: Propagation, tell: (Int, Float) => Unit): Unit =
    if of.commands.nonEmpty then tellTime(of, of.commands.length - 1, 0, tell)

  /** Writes the values that represent the time at a part's end, without its number of steps. */
  private def tellTime(of: Propagation, part: Int, from: Int, tell: (Int, Float) => Unit): Unit =
    for i <- 1 until of.perPart do tell(from + i - 1, of.numbers(part * of.perPart + i))

/** Predicts by the formulas of [[skein.lanes.timetable.PredictedLagVehicles]]. */
private final class GpuLagPrediction(code: Ptx, agent: RolloutAgent, gain: Double) extends GpuPrediction:
  private val predicted = Variables(code, Seq.fill(4)(0f))
  private val speed     = code.constant((agent.speed * gain).toFloat)

  def begin(now: GpuRecord, reading: Vector[Int]): Unit =
    val (carried, kept)      = (now.time(0), now.time(1))
    val Vector(x, y, vx, vy) = reading: @unchecked
    def times(v: Int)        = code.two("mul.rn", v, kept)
    predicted.take(Seq(code.fma(vx, carried, x), code.fma(vy, carried, y), times(vx), times(vy)))

  def go(now: GpuRecord, north: Int, east: Int): Unit =
    val Vector(moved, faster) = Vector(0, 1).map(i => code.two("mul.rn", now.time(i), speed)): @unchecked
    predicted.take(Seq(
      code.fma(north, moved, predicted(0)),
      code.fma(east, moved, predicted(1)),
      code.fma(north, faster, predicted(2)),
      code.fma(east, faster, predicted(3))
    ))

  def end(now: GpuRecord): Vector[Int] = Vector.tabulate(4)(predicted(_))

/** Predicts as [[skein.lanes.timetable.PredictedPlants]] does, for plants whose state equals the reading. */
private final class GpuPlantPrediction(code: Ptx, agent: RolloutAgent, lanes: PlantLanes)
    extends GpuPrediction:
  private val zero    = code.constant(0f)
  private val flight  = GpuStages(code, lanes, agent.speed, zero, zero)
  private val state   = Variables(code, Seq.fill(lanes.count)(0f))
  private val isBegun = code.fresh()

  def begin(now: GpuRecord, reading: Vector[Int]): Unit =
    state.take(reading)
    code.whole(0, isBegun): Unit

  def go(now: GpuRecord, north: Int, east: Int): Unit =
    val (first, over) = (code.label(), code.label())
    code.goIf(code.compareWhole("eq", isBegun, 0), first)
    flight.act(north, east, number => now.time(1 + lanes.stages.times + number))
    code.go(over)
    code.place(first)
    flight.begin(north, east, state(_))
    code.whole(1, isBegun): Unit
    code.place(over)
    flight.goOn(code.wholeOf(now.time(0)))

  def end(now: GpuRecord): Vector[Int] = flight.look(withVelocity = true, now.time)
