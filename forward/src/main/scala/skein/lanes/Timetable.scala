package skein.lanes

import skein.forward.{Delays, Duel, Duelist, LoopTiming, Rollout, Vehicle, VelocityResponse}
import skein.policy.{Decided, PlanarObservation, ObservingPolicy, Policy}

/** When everything happens in one episode, compiled for [[TimetableKernel]]. No event's time depends on where the
  * vehicles are, so all candidates that meet the same delays share one timetable, whatever their policies decide.
  *
  * It is what [[Rollout]] does: the episode is flown once with vehicles that answer with the number of the reading
  * instead of a position, and policies that answer with the number of the decision instead of a heading. So it holds for
  * every loop whose decisions rest on readings as they were made.
  *
  * @param operations
  *   [[Timetable.Fields]] numbers each: the kind, of [[TimetableKernel]]; the vehicle or agent; then places
  * @param times
  *   [[Timetable.Numbers]] numbers each: of what happens to a vehicle, what its [[VehicleClock]] tells; of a decision, the
  *   time since the one before, and the ages of the own and of the opponent's reading; of a score, the time; s
  * @param readings
  *   places that the readings of one vehicle need at a time
  * @param headings
  *   the same for the headings of one vehicle
  */
private[skein] final class Timetable private (
    val operations: Array[Int],
    val times: Array[Float],
    val readings: Int,
    val headings: Int
):
  def size: Int = operations.length / Timetable.Fields

private[skein] object Timetable:
  val Fields: Int  = 7
  val Numbers: Int = 3

  /** The timetable of a world of this key, for vehicles of this kind. */
  def of(durationS: Double, timing: LoopTiming, link: Delays, key: Int, model: TimetableModel): Timetable =
    val notes               = Notes(model)
    def duelist(agent: Int) = Duelist(1, agent, 0, 0, 0, notes.policies(agent))
    Rollout(Duel(duelist(1), duelist(0), durationS), timing, link, notes).fly(key, 0.0, notes): Unit
    Compiler(notes, durationS, model).result

  import TimetableKernel.{ACT, DECIDE, LOOK, SCORE}

  /** Flies along and notes what happens, in the order in which it does. */
  private final class Notes(model: TimetableModel) extends VelocityResponse, Rollout.Listener:
    var size               = 0
    var looks              = 0
    private var now        = 0.0
    private var capacity   = 4096
    var kind: Array[Int]   = Array.ofDim[Int](capacity)
    var agent: Array[Int]  = Array.ofDim[Int](capacity)
    var atS: Array[Double] = Array.ofDim[Double](capacity) // a decision's: not before

    // Of a decision.
    var elapsedS, ownAgeS, opponentAgeS: Array[Double] = Array.ofDim[Double](capacity)

    /** `LOOK`: the reading's number. `ACT`: the heading's. `DECIDE`: that of the heading before; the new one's is one more. */
    var number: Array[Int] = Array.ofDim[Int](capacity)

    // `DECIDE` and `SCORE`: the numbers of the readings; `DECIDE`: that of the opponent's heading that is known.
    var evaderSeen, pursuerSeen, opponent: Array[Int] = Array.ofDim[Int](capacity)

    private def note(what: Int, who: Int, time: Double, which: Int): Unit =
      if size == capacity then grow()
      kind(size) = what; agent(size) = who; atS(size) = time; number(size) = which
      size += 1

    private def grow(): Unit =
      capacity *= 2
      kind = kind.padTo(capacity, 0); agent = agent.padTo(capacity, 0); number = number.padTo(capacity, 0)
      evaderSeen = evaderSeen.padTo(capacity, 0); pursuerSeen = pursuerSeen.padTo(capacity, 0)
      opponent = opponent.padTo(capacity, 0)
      atS = atS.padTo(capacity, 0.0); elapsedS = elapsedS.padTo(capacity, 0.0)
      ownAgeS = ownAgeS.padTo(capacity, 0.0); opponentAgeS = opponentAgeS.padTo(capacity, 0.0)

    override def handoverS: Double = model.handoverS

    def create(): Vehicle = new Vehicle:
      private var who                                  = 0
      private var reading                              = 0
      def start(x: Double, y: Double, z: Double): Unit = who = x.toInt
      def command(vx: Double, vy: Double): Unit        =
        note(ACT, who, now + model.deadTimeS, (StrictMath.atan2(vy, vx) / Turn).round.toInt)
      def advance(timeS: Double): Unit =
        now = timeS
        reading = 0
      def x: Double =
        if reading == 0 then
          looks += 1
          reading = looks
          note(LOOK, who, now, reading)
        if who == 0 then reading else -reading * Pursuers
      def y: Double  = 0
      def vx: Double = 0
      def vy: Double = 0

    val policies: Vector[Policy] = Vector.tabulate(2): who =>
      new ObservingPolicy[Unit]:
        def initial: Unit                                          = ()
        def decide(seen: PlanarObservation, memory: Unit): Decided[Unit] =
          val before = (seen.ownHeadingRad / Turn).round.toInt
          note(DECIDE, who, now, before)
          noteSeen(seen.dxM.abs)
          opponent(size - 1) = (seen.opponentHeadingRad / Turn).round.toInt
          elapsedS(size - 1) = seen.elapsedS
          ownAgeS(size - 1) = seen.ownAgeS
          opponentAgeS(size - 1) = seen.opponentAgeS
          Decided((before + 1) * Turn, ())

    def scored(timeS: Double, evaderX: Double, evaderY: Double, pursuerX: Double, pursuerY: Double): Unit =
      note(SCORE, 0, timeS, 0)
      noteSeen(evaderX - pursuerX)

    private def noteSeen(both: Double): Unit =
      val pursuer = (both / Pursuers).toInt
      evaderSeen(size - 1) = (both - pursuer * Pursuers).toInt
      pursuerSeen(size - 1) = pursuer

  /** Makes room for readings of the evader in a number that holds one of each. */
  private val Pursuers = (1 << 24).toDouble

  /** Heading that stands for one decision, rad: far above the rounding of an arc tangent, and a million make no turn. */
  private val Turn = 1e-6

  /** Puts events in the order of their times, chooses places for readings and headings, each until its last use, and
    * tells each vehicle when what happens to it.
    */
  private final class Compiler(notes: Notes, durationS: Double, model: TimetableModel):
    private val order    = inOrder
    private val scores   = notes.kind.iterator.take(notes.size).count(_ == SCORE)
    private val end      = endOf(scores)
    private val readings = Array.fill(2)(Places(notes.looks + 1))
    private val headings = Array.fill(2)(Places(notes.size + 1))
    private val clocks   = Array.fill(2)(model.clock())

    private val operations = Array.ofDim[Int](end * Fields)
    private val times      = Array.ofDim[Float](end * Numbers)
    private var size       = 0

    def result: Timetable =
      for i <- 0 until end do findLastUses(order(i), i)
      for agent <- 0 to 1 do headings(agent).take(0)
      for i <- 0 until end do
        val event = order(i)
        notes.kind(event) match
          case LOOK   => look(event)
          case DECIDE => decide(event, i)
          case ACT    => act(event, i)
          case SCORE  => score(event, i)
      Timetable(
        java.util.Arrays.copyOf(operations, size * Fields),
        java.util.Arrays.copyOf(times, size * Numbers),
        readings.map(_.size).max,
        headings.map(_.size).max
      )

    /** By time, and events of one time as they were noted. Only commands act later than what was noted after them. */
    private def inOrder: Array[Int] =
      val sorted = Array.range(0, notes.size)
      for i <- 1 until sorted.length do
        val event = sorted(i)
        var hole  = i
        while hole > 0 && notes.atS(sorted(hole - 1)) > notes.atS(event) do
          sorted(hole) = sorted(hole - 1)
          hole -= 1
        sorted(hole) = event
      sorted

    /** Behind the last score. */
    private def endOf(count: Int): Int =
      var (i, seen) = (0, 0)
      while seen < count do
        if notes.kind(order(i)) == SCORE then seen += 1
        i += 1
      i

    private def findLastUses(event: Int, at: Int): Unit =
      val agent = notes.agent(event)
      notes.kind(event) match
        case DECIDE =>
          readings(0).usedAt(notes.evaderSeen(event), at)
          readings(1).usedAt(notes.pursuerSeen(event), at)
          headings(agent).usedAt(notes.number(event), at)
          headings(1 - agent).usedAt(notes.opponent(event), at)
          // Its effort is counted even where nobody uses it.
          headings(agent).usedAt(notes.number(event) + 1, at)
        case ACT   => headings(agent).usedAt(notes.number(event), at)
        case SCORE =>
          readings(0).usedAt(notes.evaderSeen(event), at)
          readings(1).usedAt(notes.pursuerSeen(event), at)
        case LOOK => ()

    private def look(event: Int): Unit =
      val vehicle = notes.agent(event)
      val reading = notes.number(event)
      if readings(vehicle).isUsed(reading) then
        operation(LOOK, vehicle, readings(vehicle).take(reading))
        happens(event, acts = false)

    private def decide(event: Int, at: Int): Unit =
      val agent    = notes.agent(event)
      val own      = notes.number(event)
      val opponent = notes.opponent(event)
      operation(
        DECIDE,
        agent,
        readings(0).place(notes.evaderSeen(event)),
        readings(1).place(notes.pursuerSeen(event)),
        headings(1 - agent).place(opponent),
        headings(agent).place(own),
        // Taken before the one before is given back: its effort is counted from there.
        headings(agent).take(own + 1)
      )
      times(size * Numbers + 1) = notes.ownAgeS(event).toFloat
      times(size * Numbers + 2) = notes.opponentAgeS(event).toFloat
      took(notes.elapsedS(event))
      readings(0).release(notes.evaderSeen(event), at)
      readings(1).release(notes.pursuerSeen(event), at)
      headings(agent).release(own, at)
      headings(1 - agent).release(opponent, at)
      headings(agent).release(own + 1, at)

    private def act(event: Int, at: Int): Unit =
      val vehicle = notes.agent(event)
      operation(ACT, vehicle, headings(vehicle).place(notes.number(event)))
      happens(event, acts = true)
      headings(vehicle).release(notes.number(event), at)

    private def score(event: Int, at: Int): Unit =
      val (evader, pursuer) = (notes.evaderSeen(event), notes.pursuerSeen(event))
      val isLast            = Rollout.isLast10s(notes.atS(event), durationS)
      operation(SCORE, 0, readings(0).place(evader), readings(1).place(pursuer), if isLast then 1 else 0)
      took(notes.atS(event))
      readings(0).release(evader, at)
      readings(1).release(pursuer, at)

    private def operation(
        kind: Int,
        agent: Int,
        a: Int,
        b: Int = 0,
        c: Int = 0,
        d: Int = 0,
        e: Int = 0
    ): Unit =
      val at = size * Fields
      operations(at) = kind; operations(at + 1) = agent
      operations(at + 2) = a; operations(at + 3) = b; operations(at + 4) = c
      operations(at + 5) = d; operations(at + 6) = e

    /** Ends an operation that happens to a vehicle. */
    private def happens(event: Int, acts: Boolean): Unit =
      clocks(notes.agent(event)).tell(notes.atS(event), acts, times, size * Numbers)
      size += 1

    /** Ends another operation. */
    private def took(seconds: Double): Unit =
      times(size * Numbers) = seconds.toFloat
      size += 1

  /** Places for numbered things until their last use; as few as possible. */
  private final class Places(numbers: Int):
    private val lastUse = Array.fill(numbers)(-1)
    private val placeOf = Array.ofDim[Int](numbers)
    private val unused  = Array.ofDim[Int](numbers)
    private var free    = 0
    private var most    = 0

    def size: Int = most

    def isUsed(number: Int): Boolean = lastUse(number) >= 0

    def usedAt(number: Int, at: Int): Unit = lastUse(number) = at

    def place(number: Int): Int = placeOf(number)

    def take(number: Int): Int =
      if free > 0 then
        free -= 1
        placeOf(number) = unused(free)
      else
        placeOf(number) = most
        most += 1
      placeOf(number)

    /** Gives the place back if this was its last use. */
    def release(number: Int, at: Int): Unit =
      if lastUse(number) == at then
        unused(free) = placeOf(number)
        free += 1
        // Two agents may have used it in the same event.
        lastUse(number) = Released

  private val Released = Int.MaxValue
