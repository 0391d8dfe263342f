package skein.lanes

import java.util.Comparator
import skein.forward.{Delays, ImageTiming, LoopTiming, Rollout}
import skein.fusion.SensorModel
import skein.vehicle.ConstantVelocity

/** When everything happens in one episode, compiled for [[TimetableKernel]]. No event's time depends on where
  * the vehicles are, so all candidates that meet the same delays share one timetable, whatever their policies
  * decide.
  *
  * It is what [[Rollout]] does: an episode is flown once with vehicles that stand still, and an observer
  * notes what happens: what is read, what is predicted from which reading through which commands, what is
  * decided upon that, and when it acts.
  *
  * @param vehicles how many fly
  * @param operations [[Timetable.Fields]] numbers each: the kind, of [[TimetableKernel]]; the vehicle; then
  *   places
  * @param numbers how many `times` there are of each operation
  * @param times of each operation: of what happens to a vehicle, what its [[EventClock]] tells; of a
  *   decision, the time since the one before, and in a duel the ages of the own and of the opponent's
  *   reading; by who sees, the age of the own reading, the time, and until when a belief is carried
  *   ([[TimetableEye.look]]); of an image what [[TimetableEye.expose]] takes; of a score, the time; s
  * @param views what is decided and scored upon: the places of all vehicles' readings, one view after the
  *   other
  * @param propagations by which readings are carried forward, in loops that predict
  * @param readings places that the readings of one vehicle need at a time
  * @param headings the same for the headings of one vehicle
  */
private[skein] final class Timetable private[lanes] (
    val vehicles: Int,
    val operations: Array[Int],
    val numbers: Int,
    val times: Array[Float],
    val views: Array[Int],
    val propagations: Array[Propagation],
    val readings: Int,
    val headings: Int
):
  def size: Int = operations.length / Timetable.Fields

  /** About so much memory is held, bytes. */
  def bytes: Long =
    4L * (operations.length + times.length + views.length) + propagations.iterator.map(_.bytes).sum

private[skein] object Timetable:
  val Fields: Int = 6

  /** Numbers of a reading: position and velocity, north and east. */
  private[lanes] val Read: Int = LaneObservation.READ

  /** Of an operation, at least: some clocks tell more. */
  private[lanes] val LeastNumbers: Int = 4

  /** The timetable of a world of this key, for so many vehicles of this kind.
    *
    * @param eyes of vehicles that see, in a duel
    */
  def of(
      vehicles: Int,
      durationS: Double,
      timing: LoopTiming,
      link: Delays,
      key: Int,
      model: LaneDynamics,
      eyes: Map[Int, SensorModel] = Map.empty
  ): Timetable =
    val notes = TimetableNotes(vehicles, model, eyes)
    Rollout(
      StandingStill.engagement(vehicles, durationS, eyes),
      unpredicted(timing),
      link,
      StandingStill.Response(model.handoverS)
    ).fly(key, observer = notes): Unit
    TimetableCompiler(notes, vehicles, model).result

  /** The same loop; what stands still is predicted at no cost. */
  private def unpredicted(timing: LoopTiming): LoopTiming = timing match
    case predictive: LoopTiming.Predictive => predictive.copy(predictor = ConstantVelocity)
    case other                             => other

/** Puts events in the order of their times, chooses places for readings and headings, each until its last
  * use, and tells each vehicle when what happens to it.
  */
private final class TimetableCompiler(
    notes: TimetableNotes,
    vehicles: Int,
    model: LaneDynamics
):
  import Timetable.Fields
  import TimetableKernel.{ACT, DECIDE, EXPOSE, JOIN, LOOK, PREDICT, SCORE}

  /** By time, and events of one time as they were noted. Only commands act later than what was noted after
    * them.
    */
  private val order = notes.all.toArray
  java.util.Arrays.sort(order, Comparator.comparingDouble[Note](_.atS))

  /** Behind the last score. */
  private val end = order.lastIndexWhere(_.kind == SCORE) + 1

  private val readings = Array.tabulate(vehicles)(vehicle => ReusedPlaces(notes.looks(vehicle) + 1))
  private val headings = Array.tabulate(vehicles)(vehicle => ReusedPlaces(notes.decisions(vehicle) + 1))
  private val clocks   = Array.fill(vehicles)(model.clock())

  /** Readings that are decided upon; of others only places count. */
  private val decidedUpon =
    Array.tabulate(vehicles)(vehicle => Array.ofDim[Boolean](notes.looks(vehicle) + 1))

  /** The number of each view among those that are told, or −1. */
  private val told         = Array.fill(notes.views.size)(-1)
  private val propagations = Array.newBuilder[Propagation]
  private var placed       = 0
  private val views        = Array.newBuilder[Int]
  private var count        = 0

  private val operations = Array.ofDim[Int](end * Fields)
  private val numbers    = Timetable.LeastNumbers.max(clocks.map(_.numbers).max)
  private val times      = Array.ofDim[Float](end * numbers)
  private var size       = 0

  def result: Timetable =
    for i <- 0 until end do findLastUses(order(i), i)
    for heading <- headings do heading.take(0)
    for i <- 0 until end do
      val event = order(i)
      event.kind match
        case LOOK    => look(event)
        case DECIDE  => decide(event, i)
        case ACT     => act(event, i)
        case SCORE   => score(event, i)
        case PREDICT => predict(event, i)
        case EXPOSE  => expose(event, i)
        case JOIN    => join(event)
    Timetable(
      vehicles,
      java.util.Arrays.copyOf(operations, size * Fields),
      numbers,
      java.util.Arrays.copyOf(times, size * numbers),
      views.result(),
      propagations.result(),
      readings.map(_.size).max,
      headings.map(_.size).max
    )

  private def findLastUses(event: Note, at: Int): Unit =
    val agent = event.agent
    event.kind match
      case DECIDE =>
        usedAt(event.view, at)
        val seen = notes.views(event.view)
        for vehicle <- 0 until vehicles do decidedUpon(vehicle)(seen(vehicle)) = true
        headings(agent).usedAt(event.number, at)
        if vehicles == 2 then headings(1 - agent).usedAt(event.opponent, at)
        // Its effort is counted even where nobody uses it.
        headings(agent).usedAt(event.number + 1, at)
      case ACT            => headings(agent).usedAt(event.number, at)
      case SCORE | EXPOSE => usedAt(event.view, at)
      case PREDICT        =>
        readings(agent).usedAt(event.from, at)
        decidedUpon(agent)(event.from) = true
        for part <- event.propagation.parts if part.command > 0 do
          headings(agent).usedAt(part.command, at)
      case LOOK | JOIN => ()

  private def usedAt(view: Int, at: Int): Unit =
    val seen = notes.views(view)
    for vehicle <- 0 until vehicles do readings(vehicle).usedAt(seen(vehicle), at)

  private def releaseView(view: Int, at: Int): Unit =
    val seen = notes.views(view)
    for vehicle <- 0 until vehicles do readings(vehicle).release(seen(vehicle), at)

  /** Its number in the timetable; its readings keep their places until it is used for the last time. */
  private def tell(view: Int): Int =
    if told(view) < 0 then
      val seen = notes.views(view)
      for vehicle <- 0 until vehicles do views += readings(vehicle).place(seen(vehicle))
      told(view) = count
      count += 1
    told(view)

  private def look(event: Note): Unit =
    val vehicle = event.agent
    val reading = event.number
    if readings(vehicle).isUsed(reading) then
      operation(
        LOOK,
        vehicle,
        readings(vehicle).take(reading),
        if decidedUpon(vehicle)(reading) then 1 else 0
      )
      happens(event, acts = false)

  private def decide(event: Note, at: Int): Unit =
    val agent = event.agent
    val own   = event.number
    val view  = event.view
    operation(
      DECIDE,
      agent,
      tell(view),
      if vehicles == 2 then headings(1 - agent).place(event.opponent) else 0,
      headings(agent).place(own),
      // Taken before the one before is given back: its effort is counted from there.
      headings(agent).take(own + 1)
    )
    times(size * numbers + 1) = event.ownAgeS.toFloat
    times(size * numbers + 2) = event.opponentAgeS.toFloat
    times(size * numbers + 3) = event.aheadS.toFloat
    took(event.elapsedS)
    releaseView(view, at)
    headings(agent).release(own, at)
    if vehicles == 2 then headings(1 - agent).release(event.opponent, at)
    headings(agent).release(own + 1, at)

  private def predict(event: Note, at: Int): Unit =
    val vehicle = event.agent
    operation(
      PREDICT,
      vehicle,
      readings(vehicle).place(event.from),
      // Taken before the reading is given back: it is carried forward beside it.
      readings(vehicle).take(event.number),
      placed
    )
    propagations += event.propagation.placed(headings(vehicle).place)
    placed += 1
    size += 1
    readings(vehicle).release(event.from, at)
    for part <- event.propagation.parts if part.command > 0 do
      headings(vehicle).release(part.command, at)

  private def act(event: Note, at: Int): Unit =
    val vehicle = event.agent
    operation(ACT, vehicle, headings(vehicle).place(event.number))
    happens(event, acts = true)
    headings(vehicle).release(event.number, at)

  private def expose(event: Note, at: Int): Unit =
    val view = event.view
    operation(EXPOSE, event.agent, tell(view), event.number % ImageTiming.Ring)
    times(size * numbers + 1) = event.elapsedS.toFloat
    times(size * numbers + 2) = event.ownAgeS.toFloat
    times(size * numbers + 3) = event.opponentAgeS.toFloat
    took(event.atS)
    releaseView(view, at)

  private def join(event: Note): Unit =
    operation(
      JOIN,
      event.agent,
      event.number % ImageTiming.Ring,
      event.opponent,
      event.from.max(0) % ImageTiming.Ring
    )
    size += 1

  private def score(event: Note, at: Int): Unit =
    val view = event.view
    operation(SCORE, 0, tell(view))
    took(event.atS)
    releaseView(view, at)

  private def operation(
      kind: Int,
      agent: Int,
      a: Int,
      b: Int = 0,
      c: Int = 0,
      d: Int = 0
  ): Unit =
    val at = size * Fields
    operations(at) = kind; operations(at + 1) = agent
    operations(at + 2) = a; operations(at + 3) = b; operations(at + 4) = c
    operations(at + 5) = d

  /** Ends an operation that happens to a vehicle. */
  private def happens(event: Note, acts: Boolean): Unit =
    clocks(event.agent).tell(event.atS, acts, times, size * numbers)
    size += 1

  /** Ends another operation. */
  private def took(seconds: Double): Unit =
    times(size * numbers) = seconds.toFloat
    size += 1

/** Places for numbered things until their last use; as few as possible. */
private final class ReusedPlaces(numbers: Int):
  import ReusedPlaces.Released
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

private object ReusedPlaces:
  private val Released = Int.MaxValue
