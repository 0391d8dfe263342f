package skein.lanes.timetable

import java.util.Comparator
import skein.forward.{Delays, ImageTiming, LoopTiming, Rollout}
import skein.fusion.SensorModel
import skein.lanes.policy.LaneObservation
import skein.vehicle.ConstantVelocity

/** The times of all events of one episode, compiled for [[TimetableKernel]]. No event's time depends on where
  * the vehicles are, so all candidates with equal delays share one timetable, whatever their policies decide.
  *
  * It is derived from [[Rollout]]: one episode is simulated with vehicles at rest, and an observer records
  * the events: readings, predictions with their readings and commands, decisions, and when commands take
  * effect.
  *
  * @param vehicles number of vehicles
  * @param operations [[Timetable.Fields]] integers each: the kind, of [[TimetableKernel]]; the vehicle; then
  *   slots. A reading also has the upper and lower half of its time, ns, which is negative if it is true
  * @param numbers number of `times` per operation
  * @param times the times of each operation, s: for an event of a vehicle, the values of its [[EventClock]];
  *   for a decision, the time since the one before, and in a duel the ages of the vehicle's own and of the
  *   opponent's reading; with a camera, the age of the vehicle's own reading, the time, and the time for
  *   which an estimate is predicted ([[TimetableEye.look]]); for an image, the arguments of
  *   [[TimetableEye.expose]]; for a score, the time
  * @param views the inputs of decisions and scores: the slots of all vehicles' readings, view by view
  * @param propagations the steps of predictions, in loops that predict
  * @param readings number of slots that the readings of one vehicle need simultaneously
  * @param headings number of slots for the headings of one vehicle
  * @param more further inputs of decisions, if requested; then a decision's third slot is its index there
  * @param endAgesS the ages of all vehicles' readings, for operations that may end the flight, which contain
  *   their index here
  */
private[skein] final class Timetable private[lanes] (
    val vehicles: Int,
    val operations: Array[Int],
    val numbers: Int,
    val times: Array[Float],
    val views: Array[Int],
    val propagations: Array[Propagation],
    val readings: Int,
    val headings: Int,
    val more: Timetable.More = Timetable.More.None,
    val endAgesS: Array[Float] = Array.emptyFloatArray
):
  def size: Int = operations.length / Timetable.Fields

  lazy val bytes: Long =
    more.bytes + 4L * (endAgesS.length + operations.length + times.length + views.length) + propagations.iterator.map(
      _.bytes
    ).sum

private[skein] object Timetable:
  val Fields: Int = 6

  /** Number of components of a reading: position and velocity, north and east. */
  private[lanes] val Read: Int = LaneObservation.READ

  /** Minimum number of times per operation: some clocks need more. */
  private[lanes] val LeastNumbers: Int = 4

  /** The timetable of a world of this key, for as many vehicles as models.
    *
    * @param models of the vehicles
    * @param eyes the cameras, indexed by vehicle; only for two vehicles
    * @param tellsMore see [[Timetable.more]]; not for two vehicles that decide by
    *   [[skein.lanes.policy.OpponentLanes]]
    * @param end how the flight may end before its duration
    * @param sensorSeed decides which readings are missing, by default the key
    */
  def of(
      models: Vector[TimetableDynamics],
      durationS: Double,
      timing: LoopTiming,
      link: Delays,
      key: Int,
      eyes: Map[Int, SensorModel] = Map.empty,
      tellsMore: Boolean = false,
      end: OwnEnds = OwnEnds.None,
      sensorSeed: Option[Long] = None
  ): Timetable =
    val notes = TimetableNotes(models, eyes, tellsMore, end)
    Rollout(
      StandingStill.engagement(models.size, durationS, eyes),
      unpredicted(timing),
      link,
      models.map(model => StandingStill.Response(model.handoverS, model.sensors.flatMap(_.ofMissing))),
      asksPolicies = false
    ).fly(key, observer = notes, sensorSeed = sensorSeed)
    TimetableCompiler(notes, models).result

  /** The loop with a trivial predictor: vehicles at rest are predicted at no cost. */
  private def unpredicted(timing: LoopTiming): LoopTiming = timing match
    case predictive: LoopTiming.Predictive => predictive.copy(predictor = ConstantVelocity)
    case other                             => other

  /** Further inputs of decisions, indexed by decision, then by vehicle.
    *
    * @param headings slots of each vehicle's last known commanded heading
    * @param agesS ages of the readings, s
    * @param actsInS time until the command takes effect, by decision, s
    * @param timeS time at which the command takes effect, since the vehicle was first read, by decision, s
    */
  final class More(
      vehicles: Int,
      headings: Array[Int],
      agesS: Array[Float],
      val actsInS: Array[Float],
      val timeS: Array[Float]
  ):
    def heading(decision: Int, vehicle: Int): Int = headings(decision * vehicles + vehicle)
    def ageS(decision: Int, vehicle: Int): Float  = agesS(decision * vehicles + vehicle)
    private[timetable] def bytes: Long            = 4L * (headings.length + agesS.length + 2 * actsInS.length)

  object More:
    val None: More =
      More(0, Array.emptyIntArray, Array.emptyFloatArray, Array.emptyFloatArray, Array.emptyFloatArray)

/** Sorts events by their times, assigns slots to readings and headings until their last use, and encodes the
  * times for each vehicle.
  */
private final class TimetableCompiler(
    notes: TimetableNotes,
    models: Vector[TimetableDynamics]
):
  import Timetable.Fields
  import TimetableKernel.{ACT, DECIDE, END, ENTER, EXPOSE, JOIN, LOOK, PREDICT, SCORE}

  private val vehicles = models.size

  /** Events by time; those of equal times in the order of recording. Only commands take effect later than
    * events recorded after them.
    */
  private val order = notes.all.toArray
  java.util.Arrays.sort(order, Comparator.comparingDouble[Note](_.atS))

  private val end = order.lastIndexWhere(_.isInstanceOf[Note.Score]) + 1

  private val readings = Array.tabulate(vehicles)(vehicle => ReusedPlaces(notes.looks(vehicle) + 1))
  private val headings = Array.tabulate(vehicles)(vehicle => ReusedPlaces(notes.decisions(vehicle) + 1))
  private val clocks   = models.map(_.clock()).toArray

  /** Readings used by decisions; the others are used by scores, which need only positions. */
  private val decidedUpon =
    Array.tabulate(vehicles)(vehicle => Array.ofDim[Boolean](notes.looks(vehicle) + 1))

  /** Index of each view in the timetable; −1 until the view is written. */
  private val told         = Array.fill(notes.views.size)(-1)
  private val propagations = Array.newBuilder[Propagation]
  private var placed       = 0
  private val views        = Array.newBuilder[Int]
  private var count        = 0

  // Further inputs of decisions.
  private val knownHeadings         = Array.newBuilder[Int]
  private val agesS, actsInS, timeS = Array.newBuilder[Float]
  private var toldDecisions         = 0
  private val endAgesS              = Array.newBuilder[Float]
  private var ends                  = 0

  private val operations = Array.ofDim[Int](end * Fields)
  private val numbers    = Timetable.LeastNumbers.max(clocks.map(_.numbers).max)
  private val times      = Array.ofDim[Float](end * numbers)
  private var size       = 0

  def result: Timetable =
    for i <- 0 until end do findLastUses(order(i), i)
    for heading <- headings do heading.take(0)
    for i <- 0 until end do
      order(i) match
        case note: Note.Look    => look(note)
        case note: Note.Predict => predict(note, i)
        case note: Note.Enter   => enter(note, i)
        case note: Note.Decide  => decide(note, i)
        case note: Note.Act     => act(note, i)
        case note: Note.Score   => score(note, i)
        case note: Note.End     => mayEnd(note, i)
        case note: Note.Expose  => expose(note, i)
        case note: Note.Join    => join(note)
    Timetable(
      vehicles,
      java.util.Arrays.copyOf(operations, size * Fields),
      numbers,
      java.util.Arrays.copyOf(times, size * numbers),
      views.result(),
      propagations.result(),
      readings.map(_.size).max,
      headings.map(_.size).max,
      Timetable.More(vehicles, knownHeadings.result(), agesS.result(), actsInS.result(), timeS.result()),
      endAgesS.result()
    )

  private def findLastUses(note: Note, at: Int): Unit = note match
    case decide: Note.Decide =>
      import decide.{before, vehicle}
      usedAt(decide.view, at)
      val seen = notes.views(decide.view)
      for each <- 0 until vehicles do decidedUpon(each)(seen(each)) = true
      headings(vehicle).usedAt(before, at)
      decide.more match
        case Some(more) => for each <- 0 until vehicles do headings(each).usedAt(more.known(each), at)
        case None       => if vehicles == 2 then headings(1 - vehicle).usedAt(decide.opponent, at)
      // Its effort is computed from it, even if no other operation uses it.
      headings(vehicle).usedAt(before + 1, at)
    case Note.Act(vehicle, _, decision) => headings(vehicle).usedAt(decision, at)
    case score: Note.Score              => usedAt(score.view, at)
    case mayEnd: Note.End               =>
      usedAt(mayEnd.view, at)
      val seen = notes.views(mayEnd.view)
      for each <- 0 until vehicles do decidedUpon(each)(seen(each)) = true
    case image: Note.Expose                     => usedAt(image.view, at)
    case Note.Predict(vehicle, _, _, from, way) =>
      carriedAt(vehicle, from, way, at)
    case Note.Enter(vehicle, _, reading, from, way) =>
      carriedAt(vehicle, reading, way, at)
      if from > 0 then readings(vehicle).usedAt(from, at)
    case _: Note.Look | _: Note.Join => ()

  private def carriedAt(vehicle: Int, reading: Int, way: Propagation, at: Int): Unit =
    readings(vehicle).usedAt(reading, at)
    decidedUpon(vehicle)(reading) = true
    for command <- way.commands if command > 0 do headings(vehicle).usedAt(command, at)

  private def usedAt(view: Int, at: Int): Unit =
    val seen = notes.views(view)
    for vehicle <- 0 until vehicles do readings(vehicle).usedAt(seen(vehicle), at)

  private def releaseView(view: Int, at: Int): Unit =
    val seen = notes.views(view)
    for vehicle <- 0 until vehicles do readings(vehicle).release(seen(vehicle), at)

  /** Index of a view in the timetable; its readings keep their slots until its last use. */
  private def tell(view: Int): Int =
    if told(view) < 0 then
      val seen = notes.views(view)
      for vehicle <- 0 until vehicles do views += readings(vehicle).place(seen(vehicle))
      told(view) = count
      count += 1
    told(view)

  private def look(note: Note.Look): Unit =
    import note.{reading, vehicle}
    if readings(vehicle).isUsed(reading) then
      operation(
        LOOK,
        vehicle,
        readings(vehicle).take(reading),
        if decidedUpon(vehicle)(reading) then 1 else 0,
        (note.sensedNs >>> 32).toInt,
        note.sensedNs.toInt
      )
      happens(vehicle, note.atS, acts = false)

  private def decide(note: Note.Decide, at: Int): Unit =
    import note.{before, vehicle}
    operation(
      DECIDE,
      vehicle,
      tell(note.view),
      note.more match
        case Some(more)            => tellMore(more)
        case None if vehicles == 2 => headings(1 - vehicle).place(note.opponent)
        case None                  => 0
      ,
      headings(vehicle).place(before),
      // Taken before the previous heading's slot is released: the effort is the change from it.
      headings(vehicle).take(before + 1)
    )
    took(
      note.elapsedS,
      note.ownAgeS,
      if note.aheadS.isEmpty then note.opponentAgeS else note.atS,
      note.aheadS.getOrElse(0)
    )
    releaseView(note.view, at)
    headings(vehicle).release(before, at)
    note.more match
      case Some(more) => for each <- 0 until vehicles do headings(each).release(more.known(each), at)
      case None       => if vehicles == 2 then headings(1 - vehicle).release(note.opponent, at)
    headings(vehicle).release(before + 1, at)

  /** Writes the further inputs of a decision.
    *
    * @return its index among the decisions with such inputs
    */
  private def tellMore(more: Note.More): Int =
    for each <- 0 until vehicles do
      knownHeadings += headings(each).place(more.known(each))
      agesS += more.agesS(each).toFloat
    actsInS += more.actsInS.toFloat
    timeS += more.timeS.toFloat
    toldDecisions += 1
    toldDecisions - 1

  private def predict(note: Note.Predict, at: Int): Unit =
    import note.{from, vehicle}
    operation(
      PREDICT,
      vehicle,
      readings(vehicle).place(from),
      // Taken before the reading's slot is released: the prediction is computed from it.
      readings(vehicle).take(note.reading),
      placed
    )
    propagates(vehicle, note.way, at)
    readings(vehicle).release(from, at)

  private def enter(note: Note.Enter, at: Int): Unit =
    import note.{from, reading, vehicle}
    val before = if from > 0 then readings(vehicle).place(from) else -1
    operation(ENTER, vehicle, before, readings(vehicle).place(reading), placed)
    propagates(vehicle, note.way, at)
    for each <- Seq(from, reading) if each > 0 do readings(vehicle).release(each, at)

  /** Ends an operation that predicts a vehicle. */
  private def propagates(vehicle: Int, way: Propagation, at: Int): Unit =
    propagations += way.placed(headings(vehicle).place)
    placed += 1
    size += 1
    for command <- way.commands do headings(vehicle).release(command, at)

  private def act(note: Note.Act, at: Int): Unit =
    import note.{decision, vehicle}
    operation(ACT, vehicle, headings(vehicle).place(decision))
    happens(vehicle, note.atS, acts = true)
    headings(vehicle).release(decision, at)

  private def expose(note: Note.Expose, at: Int): Unit =
    operation(EXPOSE, note.vehicle, tell(note.view), note.image % ImageTiming.Ring)
    took(note.atS, note.bearingError, note.rangeError, if note.isFound then 1 else 0)
    releaseView(note.view, at)

  private def join(note: Note.Join): Unit =
    operation(
      JOIN,
      note.vehicle,
      note.image % ImageTiming.Ring,
      if note.isOlder then 1 else 0,
      note.last.max(0) % ImageTiming.Ring
    )
    size += 1

  private def score(note: Note.Score, at: Int): Unit =
    operation(SCORE, 0, tell(note.view))
    took(note.atS)
    releaseView(note.view, at)

  private def mayEnd(note: Note.End, at: Int): Unit =
    operation(END, 0, tell(note.view), ends)
    ends += vehicles
    endAgesS ++= note.agesS.map(_.toFloat)
    took(note.atS, note.sinceS)
    releaseView(note.view, at)

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

  /** Ends an operation of a vehicle's event. */
  private def happens(vehicle: Int, atS: Double, acts: Boolean): Unit =
    clocks(vehicle).tell(atS, acts, times, size * numbers)
    size += 1

  /** Ends any other operation, with these times. */
  private def took(first: Double, second: Double = 0, third: Double = 0, fourth: Double = 0): Unit =
    val at = size * numbers
    times(at) = first.toFloat; times(at + 1) = second.toFloat
    times(at + 2) = third.toFloat; times(at + 3) = fourth.toFloat
    size += 1

/** Assigns slots to numbered items until their last use; as few slots as possible. */
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

  /** Frees the slot if this was its last use. */
  def release(number: Int, at: Int): Unit =
    if lastUse(number) == at then
      unused(free) = placeOf(number)
      free += 1
      // Two agents may have used it in the same event.
      lastUse(number) = Released

private object ReusedPlaces:
  private val Released = Int.MaxValue
