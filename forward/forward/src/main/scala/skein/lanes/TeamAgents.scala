package skein.lanes

import java.util.Arrays
import skein.forward.RolloutAgent
import skein.lanes.loop.{LaneAgents, LaneOffers, LaneVectors, LoopLanes}
import skein.lanes.policy.{Directions, VehicleNumbers}
import skein.lanes.timetable.{Timetable, TimetableAgents}
import skein.units.eachBelow

/** One vehicle of a team, simulated in many worlds. */
private[lanes] trait TeamMember:
  /** Sets the start of a world's vehicle, and the parameters and memory of its policy, which must be of this
    * form.
    */
  def take(world: Int, numbers: VehicleNumbers): Unit

  /** The effort by world; empty if it was not requested. */
  def effortRad: Array[Float] = Array.emptyFloatArray

  /** Restarts one world: its vehicle is at its start at rest, and all earlier commands were along this
    * heading.
    */
  def restart(world: Int, headingRad: Float): Unit =
    throw UnsupportedOperationException("a world that restarts alone needs a timetable")

  /** The policies' memory before the decision, by component, then by world. */
  def memory: Array[Float] = Array.emptyFloatArray

  /** The memory after the decision, or after an observation without a decision. */
  def nextMemory: Array[Float] = Array.emptyFloatArray

/** A vehicle with equal delays in all worlds.
  *
  * @param altitudesDownM altitudes of all vehicles
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

  /** The headings of decisions, indexed by slot; null if they are not needed. */
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
      // The timetable keeps the first heading in slot 0.
      note(0)

  override def restart(world: Int, headingRad: Float): Unit =
    val (cos, sin) = (StrictMath.cos(headingRad).toFloat, StrictMath.sin(headingRad).toFloat)
    vehicles.restart(world, headingRad)
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
    look(all, views, view, known, times(number), decides = true)
    decisions.decide(elapsedS, headings, after)
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
  ): Unit =
    look(all, views, view, known, times(number), decides = false)
    decisions.observe(elapsedS)

  private def look(
      all: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      known: Int,
      sinceS: Float,
      decides: Boolean
  ): Unit =
    team.show(all, views, view)
    decisions.look(all, views, view, decides)
    Arrays.fill(elapsedS, sinceS)
    if asksMore then learn(all, known / WORLDS)

  /** Copies further inputs of a decision from the timetable. */
  private def learn(all: Array[TimetableAgents], decision: Int): Unit =
    val more = timetable.more
    eachBelow(all.length): vehicle =>
      val ages = decisions.agesS(vehicle)
      if ages != null then Arrays.fill(ages, more.ageS(decision, vehicle))
      if decisions.asksHeading(vehicle) then
        val other = all(vehicle).asInstanceOf[TeamAgents]
        decisions.knows(vehicle, other.told, more.heading(decision, vehicle) * WORLDS)
    if decisions.actsInS != null then Arrays.fill(decisions.actsInS, more.actsInS(decision))
    if decisions.timeS != null then Arrays.fill(decisions.timeS, more.timeS(decision))

private[lanes] object TeamAgents:
  def of(team: Vector[RolloutAgent], models: Vector[LaneDynamics], views: TeamViews): Array[TeamAgents] =
    val all = Array.tabulate(team.size): self =>
      TeamAgents(self, team(self), models(self), views, team.map(_.altitudeDownM))
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
  private val ownAgeS   = Array.ofDim[Float](TimetableAgents.WORLDS)

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
    // Predictions differ from decision to decision.
    team.show(if forecast == null then offers.beat else offers.beat * all.length + self)
    if asksMore then learn(all, offers, vectors, readAt)
    decisions.decide(elapsedS, decidedNow, 0)

  private def learn(
      all: Array[LaneAgents],
      offers: LaneOffers,
      vectors: LaneVectors,
      readAt: Array[Array[Int]]
  ): Unit =
    eachBelow(all.length): vehicle =>
      val ages = decisions.agesS(vehicle)
      if ages != null then age(vehicle, readAt, ages)
      if decisions.asksHeading(vehicle) then
        val other = all(vehicle).asInstanceOf[LoopTeamAgents]
        val known = decisions.known(vehicle)
        if together then decisions.knows(vehicle, other.told, 0)
        else
          other.knownAt(vectors, offers.joinedAt, other.told, other.toldBefore, known)
          decisions.knows(vehicle, known, 0)
    if decisions.actsInS != null && forecast != null then
      System.arraycopy(forecast.actsS, 0, decisions.actsInS, 0, decisions.actsInS.length)
    if decisions.timeS != null then
      age(self, readAt, ownAgeS)
      timeAt(ownAgeS, decisions.timeS)

  override def remember(vectors: LaneVectors, endGrains: Int): Unit =
    decisions.commitBefore(decides, LaneOffers.NONE)
    if told != null then
      val (cos, sin) = decisions.direction
      tell(vectors, cos, sin, told, toldBefore)

private[lanes] object LoopTeamAgents:
  def of(
      team: Vector[RolloutAgent],
      loop: LoopLanes,
      models: Vector[LaneDynamics],
      views: TeamViews
  ): Array[LoopTeamAgents] =
    val all = Array.tabulate(team.size): self =>
      LoopTeamAgents(self, team(self), loop, models(self), views, team.map(_.altitudeDownM))
    for (vehicle, self) <- all.zipWithIndex; call <- views.call +: all.toVector.flatMap(_.decisions.calls) do
      call.show(self, vehicle.seen, vehicle.seenFrom)
    for asking <- all; other <- all.indices if asking.decisions.asksHeading(other) && all(other).told == null
    do
      all(other).told = Directions(TimetableAgents.WORLDS)
      all(other).toldBefore = Directions(TimetableAgents.WORLDS)
    all
