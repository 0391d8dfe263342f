package skein.lanes

import java.util.Arrays
import skein.forward.RolloutAgent
import skein.lanes.loop.{LaneAgents, LaneOffers, LaneVectors, LoopLanes}
import skein.lanes.policy.{Directions, TeamLanes, VehicleNumbers}
import skein.lanes.timetable.{Timetable, TimetableAgents, ViewCall}

/** The values that several vehicles of a team compute from one view, in many worlds. Mutable. */
private[lanes] final class TeamViews(val lanes: TeamLanes):
  private val worlds = TimetableAgents.WORLDS
  val call: ViewCall = ViewCall(lanes.shared, lanes.reading)
  private var last   = TeamViews.Nothing

  val values: Array[Float] = Array.ofDim(lanes.shared.outputs * worlds)
  for number <- 0 until lanes.shared.outputs do call.call.output(number, values, number * worlds)

  /** Resets to the start of an episode, of which the first worlds count. */
  def start(worlds: Int): Unit =
    call.call.use(worlds)
    last = TeamViews.Nothing

  /** Computes [[values]] of a view, unless they were computed already. */
  def show(all: Array[TimetableAgents], views: Array[Int], view: Int): Unit =
    if isNew(view) then
      call.look(all, views, view)
      call.call.apply()

  /** Computes the values from the present readings of all vehicles, in the order of their numbers.
    *
    * @param beat number of the readings
    */
  def show(beat: Int): Unit = if isNew(beat) then call.call.apply()

  /** Makes the next view new, whatever it is: some world's readings changed. */
  def forget(): Unit = last = TeamViews.Nothing

  private def isNew(view: Int) =
    val isAsked = lanes.shared.outputs > 0 && view != last
    last = view
    isAsked

private object TeamViews:
  private val Nothing = -1

/** The decisions of one vehicle of a team in many worlds, each with its own start and policy. Mutable.
  *
  * @param altitudesDownM of all vehicles
  */
private[lanes] final class TeamDecisions(self: Int, team: TeamViews, altitudesDownM: Vector[Double]):
  import TeamDecisions.Never
  import TeamLanes.Source
  import TimetableAgents.WORLDS

  private val lanes              = team.lanes
  private val bound              = lanes.functions(self)
  private val parameters         = Array.ofDim[Float](lanes.parameters(self) * WORLDS)
  private val startCos, startSin = Array.ofDim[Float](WORLDS)
  private val cruise, startDown  = Array.ofDim[Float](WORLDS)

  // Of the heading before and of the decided one.
  private var cos, sin, newCos, newSin   = Array.ofDim[Float](WORLDS)
  private var asksCos, asksSin, asksTime = Never

  // What is remembered, by number, then by world: at first, before, and after the decision.
  private val remembered        = lanes.memories(self)
  private val initial           = Array.ofDim[Float](remembered * WORLDS)
  private var memory, newMemory = Array.ofDim[Float](remembered * WORLDS)
  private val asksMemory        = Array.fill(remembered)(Never)

  /** By vehicle: age of its reading, s; filled only where it is needed. */
  val agesS: Array[Array[Float]] = Array.ofDim(lanes.count)

  /** By vehicle: its last known commanded heading, where it is needed. */
  val known: Array[Directions]           = Array.ofDim(lanes.count)
  private val asksKnownCos, asksKnownSin = Array.fill(lanes.count)(Never)

  /** Time until the command takes effect, s; null if it is not needed. */
  var actsInS: Array[Float] = null

  /** The call that reads the vehicle's observation. */
  val call: ViewCall = ViewCall(bound, lanes.reading)

  for (input, place) <- bound.inputs.zipWithIndex if lanes.reading(input).isEmpty do
    def stands(array: Array[Float], from: Int = 0): Unit = call.call.input(place, array, from)
    lanes.source(input) match
      case Source.Cos               => asksCos = place
      case Source.Sin               => asksSin = place
      case Source.Elapsed           => asksTime = place
      case Source.Cruise            => stands(cruise)
      case Source.StartDown         => stands(startDown)
      case Source.Memory(number)    => asksMemory(number) = place
      case Source.Altitude(vehicle) => stands(Array.fill(WORLDS)(altitudesDownM(vehicle).toFloat))
      case Source.Age(vehicle)      =>
        agesS(vehicle) = Array.ofDim[Float](WORLDS)
        stands(agesS(vehicle))
      case Source.ActsIn =>
        actsInS = Array.ofDim[Float](WORLDS)
        stands(actsInS)
      case Source.KnownCos(vehicle) => asksKnownCos(vehicle) = place
      case Source.KnownSin(vehicle) => asksKnownSin(vehicle) = place
      case Source.Parameter(number) => stands(parameters, number * WORLDS)
      case Source.Shared(number)    => stands(team.values, number * WORLDS)
  for vehicle <- known.indices if asksKnownCos(vehicle) >= 0 || asksKnownSin(vehicle) >= 0 do
    known(vehicle) = Directions(WORLDS)

  /** Sets a world's initial heading and policy parameters. The policy must be of this form. */
  def take(world: Int, numbers: VehicleNumbers): Unit =
    startCos(world) = numbers.cos
    startSin(world) = numbers.sin
    cruise(world) = numbers.speedMps
    startDown(world) = numbers.downM
    val count = numbers.parameters
    for number <- 0 until count do parameters(number * WORLDS + world) = numbers.policy(number)
    for number <- 0 until remembered do initial(number * WORLDS + world) = numbers.policy(count + number)

  /** Resets to the start of an episode, of which the first worlds count. */
  def start(worlds: Int): Unit =
    team.start(worlds)
    call.call.use(worlds)
    System.arraycopy(startCos, 0, cos, 0, WORLDS)
    System.arraycopy(startSin, 0, sin, 0, WORLDS)
    System.arraycopy(initial, 0, memory, 0, initial.length)

  /** Restarts one world, which was commanded in a direction before. */
  def restart(world: Int, cosOf: Float, sinOf: Float): Unit =
    team.forget()
    cos(world) = cosOf
    sin(world) = sinOf
    for at <- world until memory.length by WORLDS do memory(at) = initial(at)

  /** Cosine and sine of the last decided heading, by world. */
  def direction: (Array[Float], Array[Float]) = (cos, sin)

  def speedMps(world: Int): Float = cruise(world)

  /** The memory before the decision, by number, then by world, and after it. */
  def memories: (Array[Float], Array[Float]) = (memory, newMemory)

  /** Whether it needs another vehicle's commanded heading. */
  def asksHeading(vehicle: Int): Boolean = known(vehicle) != null

  /** Decides on the observation that [[call]] reads.
    *
    * @param elapsedS since the own last decision, by world
    * @param into receives the velocities, m/s, from an offset on
    */
  def decide(elapsedS: Array[Float], into: Directions, at: Int): Unit =
    if asksCos >= 0 then call.call.input(asksCos, cos, 0)
    if asksSin >= 0 then call.call.input(asksSin, sin, 0)
    if asksTime >= 0 then call.call.input(asksTime, elapsedS, 0)
    call.call.output(0, into.cos, at)
    call.call.output(1, into.sin, at)
    call.call.output(2, newCos, 0)
    call.call.output(3, newSin, 0)
    if lanes.inSpace then
      call.call.output(4, into.third, at)
      call.call.output(5, into.holds, at)
    var number = 0
    while number < remembered do
      if asksMemory(number) >= 0 then call.call.input(asksMemory(number), memory, number * WORLDS)
      call.call.output(lanes.decided + number, newMemory, number * WORLDS)
      number += 1
    call.call.apply()

  /** Sets where another vehicle's known heading is stored. */
  def knows(vehicle: Int, headings: Directions, at: Int): Unit =
    if asksKnownCos(vehicle) >= 0 then call.call.input(asksKnownCos(vehicle), headings.cos, at)
    if asksKnownSin(vehicle) >= 0 then call.call.input(asksKnownSin(vehicle), headings.sin, at)

  /** Makes the decisions of all worlds commands. */
  def commit(): Unit =
    val (oldCos, oldSin) = (cos, sin)
    cos = newCos; sin = newSin
    newCos = oldCos; newSin = oldSin
    if remembered > 0 then
      val before = memory
      memory = newMemory
      newMemory = before

  /** Makes the decisions of those worlds commands whose time is earlier than another. */
  def commitBefore(times: Array[Int], before: Int): Unit =
    var world = 0
    while world < WORLDS do
      if times(world) < before then
        cos(world) = newCos(world)
        sin(world) = newSin(world)
      world += 1
    var number = 0
    while number < memory.length do
      if times(number % WORLDS) < before then memory(number) = newMemory(number)
      number += 1

private object TeamDecisions:
  private val Never = -1

/** One vehicle of a team, simulated in many worlds. */
private[lanes] trait TeamMember:
  /** Sets where a world's vehicle starts, and the numbers of its policy, which must be of this form. */
  def take(world: Int, numbers: VehicleNumbers): Unit

  /** The effort by world, where it was asked for. */
  def effortRad: Array[Float] = Array.emptyFloatArray

  /** Restarts one world: its vehicle is at its start at rest, and all commands before were along a heading. */
  def restart(world: Int, headingRad: Float): Unit =
    throw UnsupportedOperationException("a world that restarts alone needs a timetable")

  /** The policies' memory before the decision, by number, then by world. */
  def memory: Array[Float] = Array.emptyFloatArray

  /** The memory after the decision, or after what is observed only. */
  def nextMemory: Array[Float] = Array.emptyFloatArray

/** A vehicle with equal delays in all worlds.
  *
  * @param altitudesDownM of all vehicles
  */
private[lanes] class TeamAgents(
    self: Int,
    agent: RolloutAgent,
    model: LaneDynamics,
    team: TeamViews,
    altitudesDownM: Vector[Double]
) extends TimetableAgents(model.vehicles(agent.copy(speed = 1))),
      TeamMember:
  import TimetableAgents.WORLDS

  private val decisions            = TeamDecisions(self, team, altitudesDownM)
  private val elapsedS             = Array.ofDim[Float](WORLDS)
  private val asksMore             = team.lanes.asksMore(self)
  private var timetable: Timetable = null

  /** Where what is not decided is written. */
  private lazy val undecided = Directions(WORLDS, vehicles.inSpace)

  /** The headings of decisions, by their places; null if they are not needed. */
  private var told: Directions = null

  /** Stores the headings commanded to this vehicle from now on. */
  private def keepHeadings(): Unit = if told == null then told = Directions(0)

  def take(world: Int, numbers: VehicleNumbers): Unit =
    vehicles.place(world, numbers)
    decisions.take(world, numbers)

  override def start(timetable: Timetable, worlds: Int): Unit =
    super.start(timetable, worlds)
    this.timetable = timetable
    decisions.start(worlds)
    if told != null then
      told.reserve(timetable.headings * WORLDS)
      // The timetable keeps the first heading at place 0.
      note(0)

  override def restart(world: Int, headingRad: Float): Unit =
    val (cos, sin) = (StrictMath.cos(headingRad).toFloat, StrictMath.sin(headingRad).toFloat)
    vehicles.restart(world)
    decisions.restart(world, cos, sin)
    if told != null then told.point(world, WORLDS, cos, sin)
    val mps = decisions.speedMps(world)
    headings.point(world, WORLDS, mps * cos, mps * sin)
    if vehicles.inSpace then headings.level(world, WORLDS, vehicles.startZ(world))

  override def memory: Array[Float]     = decisions.memories._1
  override def nextMemory: Array[Float] = decisions.memories._2

  private def note(at: Int): Unit =
    val (cos, sin) = decisions.direction
    System.arraycopy(cos, 0, told.cos, at, WORLDS)
    System.arraycopy(sin, 0, told.sin, at, WORLDS)

  /** Cosine and sine of the last decided heading, by world. */
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
    choose(all, views, view, known, times(number), headings, after)
    decisions.commit()
    if told != null then note(after)

  override def observe(
      all: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      known: Int,
      before: Int,
      times: Array[Float],
      number: Int
  ): Unit = choose(all, views, view, known, times(number), undecided, 0)

  private def choose(
      all: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      known: Int,
      sinceS: Float,
      into: Directions,
      at: Int
  ): Unit =
    team.show(all, views, view)
    decisions.call.look(all, views, view)
    Arrays.fill(elapsedS, sinceS)
    if asksMore then learn(all, known / WORLDS)
    decisions.decide(elapsedS, into, at)

  /** Copies further numbers of a decision from the timetable. */
  private def learn(all: Array[TimetableAgents], decision: Int): Unit =
    val more    = timetable.more
    var vehicle = 0
    while vehicle < all.length do
      val ages = decisions.agesS(vehicle)
      if ages != null then Arrays.fill(ages, more.ageS(decision, vehicle))
      if decisions.asksHeading(vehicle) then
        val other = all(vehicle).asInstanceOf[TeamAgents]
        decisions.knows(vehicle, other.told, more.heading(decision, vehicle) * WORLDS)
      vehicle += 1
    if decisions.actsInS != null then Arrays.fill(decisions.actsInS, more.actsInS(decision))

private[lanes] object TeamAgents:
  def of(team: Vector[RolloutAgent], model: LaneDynamics, views: TeamViews): Array[TeamAgents] =
    val all = Array.tabulate(team.size): self =>
      TeamAgents(self, team(self), model, views, team.map(_.altitudeDownM))
    for asking <- all; other <- all.indices if asking.decisions.asksHeading(other) do
      all(other).keepHeadings()
    all

/** A vehicle whose worlds have separate delays. */
private[lanes] final class LoopTeamAgents private (
    self: Int,
    agent: RolloutAgent,
    loop: LoopLanes,
    model: LaneDynamics,
    team: TeamViews,
    altitudesDownM: Vector[Double]
) extends LaneAgents(self, loop, model.deadTimeS, model.flights(agent.copy(speed = 1), loop)),
      TeamMember:

  private val decisions = TeamDecisions(self, team, altitudesDownM)
  private val asksMore  = team.lanes.asksMore(self)
  private val asksAges  = team.lanes.asksAges(self)

  /** The last and the previous commanded headings; null if they are not needed. */
  private var told, toldBefore: Directions = null

  loop.carryForward(self, agent.copy(speed = 1), vehicles)

  def take(world: Int, numbers: VehicleNumbers): Unit =
    vehicles.place(world, numbers)
    decisions.take(world, numbers)

  override def start(): Unit =
    super.start()
    decisions.start(TimetableAgents.WORLDS)
    if told != null then
      val (cos, sin) = decisions.direction
      for each <- Seq(told, toldBefore) do
        System.arraycopy(cos, 0, each.cos, 0, cos.length)
        System.arraycopy(sin, 0, each.sin, 0, sin.length)

  override def needsVelocity: Boolean = team.lanes.needsVelocity

  override def needsAges: Boolean = asksAges

  override def choose(
      all: Array[LaneAgents],
      offers: LaneOffers,
      vectors: LaneVectors,
      readAt: Array[Array[Int]]
  ): Unit =
    // What is predicted for one decision is not what is for another.
    team.show(if forecast == null then offers.beat else offers.beat * all.length + self)
    if asksMore then learn(all, offers, vectors, readAt)
    decisions.decide(elapsedS, decidedNow, 0)

  private def learn(
      all: Array[LaneAgents],
      offers: LaneOffers,
      vectors: LaneVectors,
      readAt: Array[Array[Int]]
  ): Unit =
    var vehicle = 0
    while vehicle < all.length do
      val ages = decisions.agesS(vehicle)
      if ages != null then age(vehicle, readAt, ages)
      if decisions.asksHeading(vehicle) then
        val other = all(vehicle).asInstanceOf[LoopTeamAgents]
        val known = decisions.known(vehicle)
        if together then decisions.knows(vehicle, other.told, 0)
        else
          other.knownAt(vectors, offers.joinedAt, other.told, other.toldBefore, known)
          decisions.knows(vehicle, known, 0)
      vehicle += 1
    if decisions.actsInS != null && forecast != null then
      System.arraycopy(forecast.actsS, 0, decisions.actsInS, 0, decisions.actsInS.length)

  override def remember(vectors: LaneVectors, endGrains: Int): Unit =
    decisions.commitBefore(decides, LaneOffers.NONE)
    if told != null then
      val (cos, sin) = decisions.direction
      tell(vectors, cos, sin, told, toldBefore)

private[lanes] object LoopTeamAgents:
  def of(
      team: Vector[RolloutAgent],
      loop: LoopLanes,
      model: LaneDynamics,
      views: TeamViews
  ): Array[LoopTeamAgents] =
    val all = Array.tabulate(team.size): self =>
      LoopTeamAgents(self, team(self), loop, model, views, team.map(_.altitudeDownM))
    for (vehicle, self) <- all.zipWithIndex; call <- views.call +: all.map(_.decisions.call) do
      call.show(self, vehicle.seen, vehicle.seenFrom)
    for asking <- all; other <- all.indices if asking.decisions.asksHeading(other) && all(other).told == null
    do
      all(other).told = Directions(TimetableAgents.WORLDS)
      all(other).toldBefore = Directions(TimetableAgents.WORLDS)
    all
