package skein.lanes

import java.util.Arrays
import skein.forward.RolloutAgent
import skein.lanes.loop.{LaneAgents, LaneOffers, LaneVectors, LoopLanes}
import skein.lanes.policy.{Directions, TeamLanes}
import skein.lanes.timetable.{Timetable, TimetableAgents, ViewCall}

/** What several vehicles of a team compute of one view, in many worlds. Mutable. */
private[lanes] final class TeamViews(val lanes: TeamLanes):
  private val worlds = TimetableAgents.WORLDS
  val call: ViewCall = ViewCall(lanes.shared, lanes.reading)
  private var last   = TeamViews.Nothing

  val values: Array[Float] = Array.ofDim(lanes.shared.outputs * worlds)
  for number <- 0 until lanes.shared.outputs do call.call.output(number, values, number * worlds)

  /** Back to the start of an episode, of which the first worlds count. */
  def start(worlds: Int): Unit =
    call.call.use(worlds)
    last = TeamViews.Nothing

  /** Computes [[values]] of a view, unless they stand there already. */
  def show(all: Array[TimetableAgents], views: Array[Int], view: Int): Unit =
    if isNew(view) then
      call.look(all, views, view)
      call.call.apply()

  /** The same of what is read of all vehicles now, in the order of their numbers.
    *
    * @param beat counts the readings
    */
  def show(beat: Int): Unit = if isNew(beat) then call.call.apply()

  private def isNew(view: Int) =
    val isAsked = lanes.shared.outputs > 0 && view != last
    last = view
    isAsked

private object TeamViews:
  private val Nothing = -1

/** How one vehicle of a team decides in many worlds, each with a start and a policy of its own. Mutable. */
private[lanes] final class TeamDecisions(self: Int, team: TeamViews):
  import TeamDecisions.Never
  import TeamLanes.Source
  import TimetableAgents.WORLDS

  private val lanes              = team.lanes
  private val bound              = lanes.functions(self)
  private val parameters         = Array.ofDim[Float](lanes.parameters(self) * WORLDS)
  private val startCos, startSin = Array.ofDim[Float](WORLDS)

  // Of the heading before and of the decided one.
  private var cos, sin, newCos, newSin   = Array.ofDim[Float](WORLDS)
  private var asksCos, asksSin, asksTime = Never

  /** Reads what the vehicle decides upon. */
  val call: ViewCall = ViewCall(bound, lanes.reading)

  for (input, place) <- bound.inputs.zipWithIndex if lanes.reading(input).isEmpty do
    lanes.source(input) match
      case Source.Cos               => asksCos = place
      case Source.Sin               => asksSin = place
      case Source.Elapsed           => asksTime = place
      case Source.Parameter(number) => call.call.input(place, parameters, number * WORLDS)
      case Source.Shared(number)    => call.call.input(place, team.values, number * WORLDS)

  /** Takes which way a world's vehicle heads at first, and the numbers of its policy, which must be of the
    * form.
    */
  def take(world: Int, headingRad: Double, numbers: Array[Double]): Unit =
    startCos(world) = StrictMath.cos(headingRad).toFloat
    startSin(world) = StrictMath.sin(headingRad).toFloat
    for number <- numbers.indices do parameters(number * WORLDS + world) = numbers(number).toFloat

  /** The same. */
  def start(worlds: Int): Unit =
    team.start(worlds)
    call.call.use(worlds)
    System.arraycopy(startCos, 0, cos, 0, WORLDS)
    System.arraycopy(startSin, 0, sin, 0, WORLDS)

  /** Cosine and sine of the heading decided last, by world. */
  def direction: (Array[Float], Array[Float]) = (cos, sin)

  /** Decides upon what [[call]] reads.
    *
    * @param elapsedS since the own last decision, by world
    * @param into where the velocities go, m/s, from a place on
    */
  def decide(elapsedS: Array[Float], into: Directions, at: Int): Unit =
    if asksCos >= 0 then call.call.input(asksCos, cos, 0)
    if asksSin >= 0 then call.call.input(asksSin, sin, 0)
    if asksTime >= 0 then call.call.input(asksTime, elapsedS, 0)
    call.call.output(0, into.cos, at)
    call.call.output(1, into.sin, at)
    call.call.output(2, newCos, 0)
    call.call.output(3, newSin, 0)
    call.call.apply()

  /** All worlds' decisions become commands. */
  def commit(): Unit =
    val (oldCos, oldSin) = (cos, sin)
    cos = newCos; sin = newSin
    newCos = oldCos; newSin = oldSin

  /** Those do whose time comes before another. */
  def commitBefore(times: Array[Int], before: Int): Unit =
    var world = 0
    while world < WORLDS do
      if times(world) < before then
        cos(world) = newCos(world)
        sin(world) = newSin(world)
      world += 1

private object TeamDecisions:
  private val Never = -1

/** One vehicle of a team in many worlds. */
private[lanes] trait TeamMember:
  /** Takes where a world's vehicle starts, and the numbers of its policy, which must be of the form. */
  def take(world: Int, agent: RolloutAgent, numbers: Array[Double]): Unit

/** One that meets the same delays in all worlds. */
private[lanes] class TeamAgents(self: Int, agent: RolloutAgent, model: LaneDynamics, team: TeamViews)
    extends TimetableAgents(model.vehicles(agent.copy(speed = 1))),
      TeamMember:
  import TimetableAgents.WORLDS

  private val decisions = TeamDecisions(self, team)
  private val elapsedS  = Array.ofDim[Float](WORLDS)

  def take(world: Int, agent: RolloutAgent, numbers: Array[Double]): Unit =
    vehicles.place(world, agent)
    decisions.take(world, agent.startHeadingRad, numbers)

  override def start(timetable: Timetable, worlds: Int): Unit =
    super.start(timetable, worlds)
    decisions.start(worlds)

  /** Cosine and sine of the heading decided last, by world. */
  private[lanes] def direction: (Array[Float], Array[Float]) = decisions.direction

  override def needsVelocity: Boolean = team.lanes.needsVelocity

  override def decide(
      all: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      known: Int,
      before: Int,
      after: Int,
      times: Array[Float],
      number: Int
  ): Unit =
    team.show(all, views, view)
    decisions.call.look(all, views, view)
    Arrays.fill(elapsedS, times(number))
    decisions.decide(elapsedS, headings, after)
    decisions.commit()

/** One whose worlds have delays of their own. */
private[lanes] final class LoopTeamAgents private (
    self: Int,
    agent: RolloutAgent,
    loop: LoopLanes,
    model: LaneDynamics,
    team: TeamViews
) extends LaneAgents(self, loop, model.deadTimeS, model.flights(agent.copy(speed = 1), loop)),
      TeamMember:

  private val decisions = TeamDecisions(self, team)
  loop.carryForward(self, agent.copy(speed = 1), vehicles)

  def take(world: Int, agent: RolloutAgent, numbers: Array[Double]): Unit =
    vehicles.place(world, agent)
    decisions.take(world, agent.startHeadingRad, numbers)

  override def start(): Unit =
    super.start()
    decisions.start(TimetableAgents.WORLDS)

  override def needsVelocity: Boolean = team.lanes.needsVelocity

  override def choose(
      all: Array[LaneAgents],
      offers: LaneOffers,
      vectors: LaneVectors,
      readAt: Array[Array[Int]]
  ): Unit =
    // What is predicted for one decision is not what is for another.
    team.show(if forecast == null then offers.beat else offers.beat * all.length + self)
    decisions.decide(elapsedS, decidedNow, 0)

  override def remember(vectors: LaneVectors, endGrains: Int): Unit =
    decisions.commitBefore(decides, LaneOffers.NONE)

private[lanes] object LoopTeamAgents:
  /** All of a team, by number. */
  def of(
      team: Vector[RolloutAgent],
      loop: LoopLanes,
      model: LaneDynamics,
      views: TeamViews
  ): Array[LoopTeamAgents] =
    val all = Array.tabulate(team.size)(self => LoopTeamAgents(self, team(self), loop, model, views))
    for (vehicle, self) <- all.zipWithIndex; call <- views.call +: all.map(_.decisions.call) do
      call.show(self, vehicle.seen, vehicle.seenFrom)
    all
