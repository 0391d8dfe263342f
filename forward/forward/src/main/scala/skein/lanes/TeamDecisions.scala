package skein.lanes

import skein.lanes.policy.{Directions, TeamLanes, VehicleNumbers}
import skein.lanes.timetable.{TimetableAgents, ViewCall}
import skein.simd.BoundFunction
import skein.units.{eachBelow, eachFrom}

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

  /** Computes the values from the present readings of all vehicles, in the order of the vehicles.
    *
    * @param beat the number that identifies the readings
    */
  def show(beat: Int): Unit = if isNew(beat) then call.call.apply()

  /** Discards the values, because some world's readings changed. */
  def forget(): Unit = last = TeamViews.Nothing

  private def isNew(view: Int) =
    val isAsked = lanes.shared.outputs > 0 && view != last
    last = view
    isAsked

private object TeamViews:
  private val Nothing = -1

/** The decisions of one vehicle of a team in many worlds, each with its own start and policy. Mutable.
  *
  * @param altitudesDownM altitudes of all vehicles
  */
private[lanes] final class TeamDecisions(self: Int, team: TeamViews, altitudesDownM: Vector[Double]):
  import TeamDecisions.Never
  import TeamLanes.Source
  import TimetableAgents.WORLDS

  private val lanes              = team.lanes
  private val parameters         = Array.ofDim[Float](lanes.parameters(self) * WORLDS)
  private val startCos, startSin = Array.ofDim[Float](WORLDS)
  private val cruise, startDown  = Array.ofDim[Float](WORLDS)

  // Cosine and sine of the previous and of the decided heading.
  private var cos, sin, newCos, newSin = Array.ofDim[Float](WORLDS)

  // The memory, by component, then by world: initially, before, and after the decision.
  private val initial           = Array.ofDim[Float](lanes.memories(self) * WORLDS)
  private var memory, newMemory = Array.ofDim[Float](initial.length)
  private val remembered        = lanes.remembered(self)

  /** By vehicle: age of its reading, s; filled only where it is needed. */
  val agesS: Array[Array[Float]] = Array.ofDim(lanes.count)

  /** For each vehicle, its last known commanded heading, where it is needed. */
  val known: Array[Directions] = Array.ofDim(lanes.count)

  /** Time until the command takes effect, and the time at which it does, s; null if it is not needed. */
  var actsInS, timeS: Array[Float] = null

  private val deciding  = Call(lanes.functions(self))
  private val observing = Call(lanes.sights(self))

  /** The calls that read the vehicle's observation. */
  val calls: Seq[ViewCall] = Seq(deciding.call, observing.call)

  /** A call of one of the vehicle's compiled functions. */
  private final class Call(bound: BoundFunction):
    val call: ViewCall                     = ViewCall(bound, lanes.reading)
    private var asksCos, asksSin, asksTime = Never
    private val asksMemory                 = Array.fill(remembered)(Never)
    private val asksKnownCos, asksKnownSin = Array.fill(lanes.count)(Never)

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
          if agesS(vehicle) == null then agesS(vehicle) = Array.ofDim[Float](WORLDS)
          stands(agesS(vehicle))
        case Source.ActsIn =>
          if actsInS == null then actsInS = Array.ofDim[Float](WORLDS)
          stands(actsInS)
        case Source.Time =>
          if timeS == null then timeS = Array.ofDim[Float](WORLDS)
          stands(timeS)
        case Source.KnownCos(vehicle) => asksKnownCos(vehicle) = place
        case Source.KnownSin(vehicle) => asksKnownSin(vehicle) = place
        case Source.Parameter(_)      => stands(parameters)
        case Source.Shared(number)    => stands(team.values, number * WORLDS)
    for vehicle <- known.indices if asksKnownCos(vehicle) >= 0 || asksKnownSin(vehicle) >= 0 do
      if known(vehicle) == null then known(vehicle) = Directions(WORLDS)

    /** Sets what changes from decision to decision. */
    def look(elapsedS: Array[Float]): Unit =
      if asksCos >= 0 then call.call.input(asksCos, cos, 0)
      if asksSin >= 0 then call.call.input(asksSin, sin, 0)
      if asksTime >= 0 then call.call.input(asksTime, elapsedS, 0)
      eachBelow(remembered): number =>
        if asksMemory(number) >= 0 then call.call.input(asksMemory(number), memory, number * WORLDS)

    def knows(vehicle: Int, headings: Directions, at: Int): Unit =
      if asksKnownCos(vehicle) >= 0 then call.call.input(asksKnownCos(vehicle), headings.cos, at)
      if asksKnownSin(vehicle) >= 0 then call.call.input(asksKnownSin(vehicle), headings.sin, at)

  /** Sets a world's initial heading and policy parameters. The policy must be of this form. */
  def take(world: Int, numbers: VehicleNumbers): Unit =
    startCos(world) = numbers.cos
    startSin(world) = numbers.sin
    cruise(world) = numbers.speedMps
    startDown(world) = numbers.downM
    val count = numbers.parameters
    for number <- 0 until count do parameters(number * WORLDS + world) = numbers.policy(number)
    for number <- 0 until lanes.memories(self) do
      initial(number * WORLDS + world) = numbers.policy(count + number)

  /** Resets to the start of an episode, of which the first worlds count. */
  def start(worlds: Int): Unit =
    team.start(worlds)
    for each <- calls do each.call.use(worlds)
    System.arraycopy(startCos, 0, cos, 0, WORLDS)
    System.arraycopy(startSin, 0, sin, 0, WORLDS)
    System.arraycopy(initial, 0, memory, 0, initial.length)

  /** Restarts one world, whose previous command was in this direction. */
  def restart(world: Int, cosOf: Float, sinOf: Float): Unit =
    team.forget()
    cos(world) = cosOf
    sin(world) = sinOf
    for at <- world until memory.length by WORLDS do memory(at) = initial(at)

  /** Cosine and sine of the last decided heading, by world. */
  def direction: (Array[Float], Array[Float]) = (cos, sin)

  def speedMps(world: Int): Float = cruise(world)

  /** The memory before the decision and after it, by component, then by world. */
  def memories: (Array[Float], Array[Float]) = (memory, newMemory)

  /** Whether it needs another vehicle's commanded heading. */
  def asksHeading(vehicle: Int): Boolean = known(vehicle) != null

  /** Reads the vehicle's observation from a timetable's view, to decide or to observe. */
  def look(all: Array[TimetableAgents], views: Array[Int], view: Int, decides: Boolean): Unit =
    (if decides then deciding else observing).call.look(all, views, view)

  /** Decides on the observation that was read.
    *
    * @param elapsedS time since this vehicle's previous decision, by world
    * @param into receives the velocities, m/s, from an offset on
    */
  def decide(elapsedS: Array[Float], into: Directions, at: Int): Unit =
    val call = deciding.call.call
    deciding.look(elapsedS)
    call.output(0, into.cos, at)
    call.output(1, into.sin, at)
    call.output(2, newCos, 0)
    call.output(3, newSin, 0)
    if lanes.inSpace then
      call.output(4, into.third, at)
      call.output(5, into.holds, at)
    eachBelow(remembered): number =>
      call.output(lanes.decided + number, newMemory, number * WORLDS)
    call.apply()

  /** Computes the memory on which no decision depends. */
  def observe(elapsedS: Array[Float]): Unit =
    observing.look(elapsedS)
    eachFrom(remembered, lanes.memories(self)): number =>
      observing.call.call.output(number - remembered, newMemory, number * WORLDS)
    observing.call.call.apply()

  /** Sets where another vehicle's known heading is stored. */
  def knows(vehicle: Int, headings: Directions, at: Int): Unit =
    deciding.knows(vehicle, headings, at)
    observing.knows(vehicle, headings, at)

  /** Makes the decisions of all worlds the last commands. */
  def commit(): Unit =
    val (oldCos, oldSin) = (cos, sin)
    cos = newCos; sin = newSin
    newCos = oldCos; newSin = oldSin
    if remembered > 0 then
      val before = memory
      memory = newMemory
      newMemory = before

  /** Makes the decisions the last commands in worlds whose time is earlier than `before`. */
  def commitBefore(times: Array[Int], before: Int): Unit =
    eachBelow(WORLDS): world =>
      if times(world) < before then
        cos(world) = newCos(world)
        sin(world) = newSin(world)
    eachBelow(memory.length): number =>
      if times(number % WORLDS) < before then memory(number) = newMemory(number)

private object TeamDecisions:
  private val Never = -1
