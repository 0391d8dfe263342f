package skein.lanes

import skein.forward.Duelist

/** Judges the flights of a team in many worlds. Mutable.
  *
  * @param judged what by; its quantities' numbers come from each world's own
  */
private[lanes] final class TeamScores(lanes: QuantityLanes, judged: Vector[Judged]) extends TimetableScores:
  private val worlds     = TimetableAgents.WORLDS
  private val bound      = lanes.function
  private val shown      = ViewCall(bound, lanes.reading)
  private val values     = Array.ofDim[Float](judged.size * worlds)
  private val altitudes  = Array.ofDim[Float](lanes.count * worlds)
  private val parameters =
    Array.tabulate(judged.size)(number => Array.ofDim[Float](lanes.parameters(number) * worlds))
  private val reductions = judged.map(each => LaneReduction(each.reduction)).toArray

  for number <- judged.indices do shown.call.output(number, values, number * worlds)
  for (input, place) <- bound.inputs.zipWithIndex if lanes.reading(input).isEmpty do
    lanes.altitudeOf(input) match
      case Some(vehicle) => shown.call.input(place, altitudes, vehicle * worlds)
      case None          =>
        val (number, parameter) = lanes.parameterOf(input)
        shown.call.input(place, parameters(number), parameter * worlds)

  /** Takes the numbers of what a world is judged by. */
  def take(world: Int, vehicles: Vector[Duelist], numbers: Vector[Array[Double]]): Unit =
    for (vehicle, i) <- vehicles.zipWithIndex do altitudes(i * worlds + world) = vehicle.altitudeDownM.toFloat
    for (values, number) <- numbers.zipWithIndex; i <- values.indices do
      parameters(number)(i * worlds + world) = values(i).toFloat

  def start(): Unit = reductions.foreach(_.start())

  def score(
      agents: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      isLast: Boolean,
      timeS: Float
  ): Unit =
    if judged.exists(_.counts(timeS)) then
      shown.look(agents, views, view)
      shown.call.apply()
      for number <- judged.indices if judged(number).counts(timeS) do
        reductions(number).add(values, number * worlds)

  def finish(): Unit = ()

  def value(number: Int, world: Int): Float = reductions(number).value(world)
