package skein.lanes.score

import java.util.Arrays
import skein.lanes.policy.LaneObservation
import skein.lanes.timetable.{TimetableAgents, TimetableScores, ViewCall}
import skein.simd.BoundFunction
import skein.units.eachBelow

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
  private val level      = Array.ofDim[Float](worlds)
  private val altitudes  = altitudesDownM.toArray.flatMap(down => Array.fill(worlds)(down.toFloat))
  private val parameters =
    Array.tabulate(lanes.formulas)(number => Array.ofDim[Float](lanes.parameters(number) * worlds))
  private val stages = lanes.stages.map(Stage(_)).toArray

  private val hasShare = judged.indices.map(lanes.hasShare).toArray
  private val renewed  = lanes.renewed.toArray

  /** How many of [[renewed]] have restarted. */
  private var begun = 0

  /** The time up to which positions are scored, s. */
  var untilS: Float = Float.PositiveInfinity

  for case (OfMoment.FirstWithin(limit), number) <- judged.map(_.reduction).zipWithIndex do
    this.limit(number, limit.toFloat)

  private final class Stage(of: ScoreLanes.Stage):
    val fromS: Double      = of.fromS
    val judged: Array[Int] = of.judged.toArray
    val shown: ViewCall    = showing(of.function, of.places)

  /** By world, the time of the decision at which a flight may end, and the time since the first decision, s.
    */
  val nowS, sinceS: Array[Float] = Array.ofDim[Float](worlds)

  /** By vehicle, then by world, ages of the readings from which the decision was made, s. */
  val agesS: Array[Array[Float]] = Array.ofDim[Float](if lanes.needsAges then lanes.count else 0, worlds)

  /** By world, the time since the run's first decision at which its episode began; NaN before its first
    * decision.
    */
  private val begunS = Array.ofDim[Float](worlds)

  /** Computes the end; null if there is none. */
  private val ending: ViewCall =
    lanes.ending.fold(null)(ending => showing(ending.function, Vector(ending.place)))

  /** A call that computes accumulators.
    *
    * @param places indices of the function's outputs among the accumulators
    */
  private def showing(function: BoundFunction, places: Vector[Int]): ViewCall =
    val shown = ViewCall(
      function,
      input =>
        Some(lanes.source(input)).collect:
          case Source.Reading(vehicle, field)             => (vehicle, field)
          case Source.Velocity(vehicle, axis) if axis < 2 => (vehicle, 2 + axis)
          case Source.Altitude(vehicle) if inSpace        => (vehicle, LaneObservation.DOWN)
          case Source.Velocity(vehicle, _) if inSpace     => (vehicle, LaneObservation.DOWN_MPS)
      ,
      shared
    )
    for (place, output) <- places.zipWithIndex do shown.call.output(output, kept, place * worlds)
    for (input, place) <- function.inputs.zipWithIndex do
      lanes.source(input) match
        case Source.Reading(_, _)     => ()
        case Source.Now               => shown.call.input(place, nowS, 0)
        case Source.Since             => shown.call.input(place, sinceS, 0)
        case Source.Age(vehicle)      => shown.call.input(place, agesS(vehicle), 0)
        case Source.Velocity(_, axis) => if !inSpace && axis == 2 then shown.call.input(place, level, 0)
        case Source.Altitude(vehicle) =>
          if !inSpace then shown.call.input(place, altitudes, vehicle * worlds)
        case Source.Kept(from)                   => shown.call.input(place, kept, from * worlds)
        case Source.Parameter(number, parameter) =>
          shown.call.input(place, parameters(number), parameter * worlds)
    shown

  /** Sets the parameters of a world's quantities and of its end. */
  def take(world: Int, numbers: Array[Array[Double]]): Unit =
    for number <- numbers.indices; i <- numbers(number).indices do
      parameters(number)(i * worlds + world) = numbers(number)(i).toFloat

  /** Sets the limit of a score with [[OfMoment.FirstWithin]]. */
  def limit(number: Int, most: Float): Unit = shared(ScoreLanes.ownParameter(number)) = most

  def start(worlds: Int): Unit =
    for stage <- stages do stage.shown.call.use(worlds)
    if ending != null then ending.call.use(worlds)
    shared(ScoreLanes.Time) = 0
    begun = 0
    Arrays.fill(counts, 0)
    Arrays.fill(begunS, Float.NaN)
    for place <- lanes.initial.indices do begin(place)

  private def begin(place: Int): Unit =
    Arrays.fill(kept, place * worlds, (place + 1) * worlds, lanes.initial(place))

  def forget(number: Int): Unit =
    counts(number) = 0
    for place <- lanes.places(number) until lanes.places(number + 1) do begin(place)

  /** Resets one world's score. The count of values goes on, so final means and standard deviations are then
    * wrong.
    */
  def forgetIn(world: Int, number: Int): Unit =
    for place <- lanes.places(number) until lanes.places(number + 1) do
      kept(place * worlds + world) = lanes.initial(place)

  def score(agents: Array[TimetableAgents], views: Array[Int], view: Int, timeS: Float): Unit =
    val stage = if timeS <= untilS then stageAt(timeS) else null
    if stage != null then
      stage.shown.look(agents, views, view)
      add(stage, timeS)

  override def needsVelocity: Boolean = lanes.needsVelocity

  override def end(
      agents: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      timeS: Float,
      sinceS: Float,
      agesS: Array[Float],
      ages: Int
  ): Unit =
    Arrays.fill(nowS, timeS)
    if lanes.asksSince then elapse(sinceS)
    for vehicle <- this.agesS.indices do Arrays.fill(this.agesS(vehicle), agesS(ages + vehicle))
    ending.look(agents, views, view)
    end()

  /** Computes the times since each world's first decision. */
  private def elapse(runS: Float): Unit =
    eachBelow(worlds): world =>
      if begunS(world).isNaN then begunS(world) = runS
      sinceS(world) = ScoreLanes.microseconds(runS - begunS(world))

  def hasEnd: Boolean = ending != null

  /** Whether the flight had ended in a world by the scenario's own end condition. */
  def hasEnded(world: Int): Boolean =
    lanes.ending.exists(ending => kept(ending.place * worlds + world) < Float.PositiveInfinity)

  /** Begins an episode in one world, whose flight goes on. */
  def goOn(world: Int): Unit = for ending <- lanes.ending do
    kept(ending.place * worlds + world) = lanes.initial(ending.place)
    begunS(world) = Float.NaN

  def needsAges: Boolean = agesS.nonEmpty

  /** Sets the array of a vehicle's readings, as in [[ViewCall.show]], for [[end]] without a view. */
  def placeReadings(vehicle: Int, array: Array[Float], from: Int): Unit =
    if hasEnd then ending.show(vehicle, array, from)

  /** Ends the worlds in which the flight has ended at [[nowS]], by the readings that were set. */
  def end(): Unit = ending.call.apply()

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
    while begun < renewed.length && Judged.counts(timeS, judged(renewed(begun)).fromS) do
      renew(renewed(begun), timeS)
      begun += 1
    eachBelow(stage.judged.length): i =>
      val number = stage.judged(i)
      counts(number) += 1
      if hasShare(number) then shared(ScoreLanes.ownParameter(number)) = 1f / counts(number)
    stage.shown.call.apply()

  /** Restarts a score in all worlds that have not ended before a time. */
  private def renew(number: Int, timeS: Float): Unit =
    counts(number) = 0
    val ended = lanes.ending.get.place * worlds
    for world <- 0 until worlds if kept(ended + world) >= timeS do
      forgetIn(world, number)
      for place <- lanes.counted(number) do kept(place * worlds + world) = 0

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
    val count = lanes.counted(number).fold(counts(number))(place => kept(place * worlds + world).toInt)
    ScoreLanes.value(judged(number), soFar(number, world), count)
