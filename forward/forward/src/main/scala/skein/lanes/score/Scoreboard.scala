package skein.lanes.score

import java.util.Arrays
import skein.lanes.policy.LaneObservation
import skein.lanes.timetable.{TimetableAgents, TimetableScores, ViewCall}
import skein.scenario.Reduction

/** Scores the flights of many worlds, once a period. Mutable.
  *
  * @param altitudesDownM altitudes of vehicles that fly level; empty if vehicles climb
  */
private[lanes] final class Scoreboard(lanes: ScoreLanes, altitudesDownM: Vector[Double])
    extends TimetableScores:
  import ScoreLanes.Source

  private val worlds     = TimetableAgents.WORLDS
  private val judged     = lanes.judged
  private val kept       = Array.ofDim[Float](lanes.initial.size * worlds)
  private val ends       = lanes.places.tail.toArray
  private val counts     = Array.ofDim[Int](judged.size)
  private val shared     = Array.ofDim[Float](ScoreLanes.ownParameter(judged.size))
  private val inSpace    = altitudesDownM.isEmpty
  private val altitudes  = altitudesDownM.toArray.flatMap(down => Array.fill(worlds)(down.toFloat))
  private val parameters =
    Array.tabulate(judged.size)(number => Array.ofDim[Float](lanes.parameters(number) * worlds))
  private val stages = lanes.stages.map(Stage(_)).toArray

  private val hasShare = judged.indices.map(lanes.hasShare).toArray

  for case (Judged(_, OfMoment.FirstWithin(limit), _), number) <- judged.zipWithIndex do
    this.limit(number, limit.toFloat)

  private final class Stage(of: ScoreLanes.Stage):
    val fromS: Double      = of.fromS
    val judged: Array[Int] = of.judged.toArray
    val shown: ViewCall    = ViewCall(
      of.function,
      input =>
        Some(lanes.source(input)).collect:
          case Source.Reading(vehicle, field)      => (vehicle, field)
          case Source.Altitude(vehicle) if inSpace => (vehicle, LaneObservation.DOWN)
      ,
      shared
    )
    for (place, output) <- of.places.zipWithIndex do shown.call.output(output, kept, place * worlds)
    for (input, place) <- of.function.inputs.zipWithIndex do
      lanes.source(input) match
        case Source.Reading(_, _)     => ()
        case Source.Altitude(vehicle) =>
          if !inSpace then shown.call.input(place, altitudes, vehicle * worlds)
        case Source.Kept(from)                   => shown.call.input(place, kept, from * worlds)
        case Source.Parameter(number, parameter) =>
          shown.call.input(place, parameters(number), parameter * worlds)

  /** Sets the parameters of a world's quantities. */
  def take(world: Int, numbers: Array[Array[Double]]): Unit =
    for number <- numbers.indices; i <- numbers(number).indices do
      parameters(number)(i * worlds + world) = numbers(number)(i).toFloat

  /** Sets the limit of a score with [[OfMoment.FirstWithin]]. */
  def limit(number: Int, most: Float): Unit = shared(ScoreLanes.ownParameter(number)) = most

  def start(worlds: Int): Unit =
    for stage <- stages do stage.shown.call.use(worlds)
    shared(ScoreLanes.Time) = 0
    for number <- judged.indices do forget(number)

  def forget(number: Int): Unit =
    counts(number) = 0
    for place <- lanes.places(number) until lanes.places(number + 1) do
      Arrays.fill(kept, place * worlds, (place + 1) * worlds, lanes.initial(place))

  /** Resets one world's score. The count of values goes on, so final means and standard deviations are then
    * wrong.
    */
  def forgetIn(world: Int, number: Int): Unit =
    for place <- lanes.places(number) until lanes.places(number + 1) do
      kept(place * worlds + world) = lanes.initial(place)

  def score(agents: Array[TimetableAgents], views: Array[Int], view: Int, timeS: Float): Unit =
    val stage = stageAt(timeS)
    if stage != null then
      stage.shown.look(agents, views, view)
      add(stage, timeS)

  /** Sets the arrays of a vehicle's positions, by world, for [[score]] without a view. */
  def place(vehicle: Int, north: Array[Float], northAt: Int, east: Array[Float], eastAt: Int): Unit =
    for stage <- stages do
      stage.shown.show(vehicle, 0, north, northAt)
      stage.shown.show(vehicle, 1, east, eastAt)

  /** Sets the array of a vehicle's positions down, by world. */
  def placeDown(vehicle: Int, down: Array[Float], at: Int): Unit =
    for stage <- stages do stage.shown.show(vehicle, LaneObservation.DOWN, down, at)

  def counts(timeS: Float): Boolean = stageAt(timeS) != null

  /** Scores the [[place placed]] positions of all vehicles, at a time for which [[counts]] is true. */
  def score(timeS: Float): Unit = add(stageAt(timeS), timeS)

  private def stageAt(timeS: Float): Stage =
    var last = stages.length - 1
    while last >= 0 && !Judged.counts(timeS, stages(last).fromS) do last -= 1
    if last < 0 then null else stages(last)

  private def add(stage: Stage, timeS: Float): Unit =
    shared(ScoreLanes.Time) = timeS
    var i = 0
    while i < stage.judged.length do
      val number = stage.judged(i)
      counts(number) += 1
      if hasShare(number) then shared(ScoreLanes.ownParameter(number)) = 1f / counts(number)
      i += 1
    stage.shown.call.apply()

  /** Time of the last score, since the start, s. */
  def scoredAtS: Float = shared(ScoreLanes.Time)

  private def soFar(number: Int, world: Int): Float = kept((ends(number) - 1) * worlds + world)

  /** Writes the last accumulator of a score, by world. */
  def soFar(number: Int, into: Array[Float]): Unit =
    System.arraycopy(kept, (ends(number) - 1) * worlds, into, 0, worlds)

  /** The final values of a score in all worlds. */
  def values(number: Int): Array[Float] = Array.tabulate(worlds)(value(number, _))

  /** The final value of a score in one world; NaN without values. */
  def value(number: Int, world: Int): Float =
    ScoreLanes.value(judged(number).reduction, soFar(number, world), counts(number))

private[lanes] object Scoreboard:
  /** Scores the distance between two vehicles.
    *
    * @param by reductions of the distance, each with the time from which values count, s
    */
  def ofDistance(by: (Reduction | OfMoment, Double)*): Scoreboard =
    Scoreboard(ScoreLanes.ofDistance(by*), Vector(0, 0))
