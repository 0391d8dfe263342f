package skein.lanes

import skein.gpu.Ptx

/** Where a thread of a GPU keeps what its vehicles' readings and commands are: bytes of its own memory.
  *
  * @param readings places of one vehicle
  * @param headings the same
  */
private[lanes] final case class GpuLayout(vehicles: Int, readings: Int = 4, headings: Int = 4):
  import LaneObservation.READ
  private val firstHeading = 4 * READ * vehicles * readings

  /** Behind it is room for whatever a kernel keeps besides. */
  val bytes: Int = firstHeading + 8 * vehicles * headings

  /** Where a reading begins. */
  def reading(vehicle: Int, place: Int): Int = 4 * READ * (vehicle * readings + place)

  /** Where a heading's cosine and sine are, or a commanded velocity. */
  def heading(vehicle: Int, place: Int): Int = firstHeading + 8 * (vehicle * headings + place)

  /** One with room for an episode, too. */
  def holding(timetable: Timetable): GpuLayout =
    def doubled(now: Int, needed: Int) = if needed <= now then now else Integer.highestOneBit(needed * 2 - 1)
    copy(readings = doubled(readings, timetable.readings), headings = doubled(headings, timetable.headings))

/** A [[Timetable]] as [[GpuKernel]] reads it: of each operation [[stride]] words, which are the number of its
  * label, where in own memory are what it takes and leaves, and its times; then the views, of each where the
  * readings of all vehicles are.
  */
private[lanes] final class GpuTimetable(timetable: Timetable, layout: GpuLayout):
  import GpuTimetable.*
  require(layout.holding(timetable) == layout, s"$layout has no room for ${timetable.readings} readings")

  private val count  = layout.vehicles
  private val labels = Labels(count)

  /** The fields of an operation, and its times. */
  private type Record = (Array[Int], Array[Float])

  private val operations: Vector[Record] =
    var shown = -1
    Vector.range(0, timetable.size).flatMap: i =>
      kindOf(i) match
        case TimetableKernel.PREDICT => predictionOf(i)
        case kind                    =>
          val own  = (fieldsOf(i), timesOf(i))
          val view = timetable.operations(i * Timetable.Fields + 2)
          // What several vehicles compute of a view is computed once.
          if kind == TimetableKernel.DECIDE && view != shown then
            shown = view
            Vector((Array(labels.show, own._1(1)), own._2), own)
          else Vector(own)

  val stride: Int = (Timetable.Fields + operations.iterator.map(_._2.length).max + 3) / 4 * 4

  def size: Int = operations.size

  val words: Array[Int] =
    val places = timetable.views.indices.map(i => layout.reading(i % count, timetable.views(i)))
    operations.iterator.flatMap(wordsOf).toArray ++ places

  /** When it is scored, s. */
  val scoredAtS: Array[Float] =
    Array.range(0, timetable.size).filter(kindOf(_) == TimetableKernel.SCORE).map(i =>
      timetable.times(i * timetable.numbers)
    )

  private def kindOf(i: Int) = timetable.operations(i * Timetable.Fields)

  private def timesOf(i: Int) = timetable.times.slice(i * timetable.numbers, (i + 1) * timetable.numbers)

  private def wordsOf(record: Record): Array[Int] =
    val (fields, times) = record
    val made            = java.util.Arrays.copyOf(fields, stride)
    for (time, number) <- times.zipWithIndex do
      made(Timetable.Fields + number) = java.lang.Float.floatToRawIntBits(time)
    made

  private def predictionOf(i: Int): Vector[Record] =
    val at                = i * Timetable.Fields
    val agent             = timetable.operations(at + 1)
    def place(field: Int) = layout.reading(agent, timetable.operations(at + 1 + field))
    val propagation       = timetable.propagations(timetable.operations(at + 4))
    val (first, of, last) = GpuPrediction.numbersOf(propagation)
    val parts             =
      for (part, numbers) <- propagation.parts.toVector.zip(of) yield
        val command = if part.command == Propagation.Rest then -1 else layout.heading(agent, part.command)
        (Array(labels.carry(agent), command), numbers)
    (Array(labels.predict(agent), place(1)), first) +: parts :+ (
      Array(labels.predicted(agent), place(2)),
      last
    )

  private def fieldsOf(i: Int): Array[Int] =
    val at                = i * Timetable.Fields
    val agent             = timetable.operations(at + 1)
    def place(field: Int) = timetable.operations(at + 1 + field)
    // From here on, in words: nobody knows yet how many operations there are.
    def view = count * place(1)
    kindOf(i) match
      case TimetableKernel.LOOK =>
        Array(labels.look(agent, withVelocity = place(2) != 0), layout.reading(agent, place(1)))
      case TimetableKernel.ACT    => Array(labels.act(agent), layout.heading(agent, place(1)))
      case TimetableKernel.DECIDE =>
        Array(
          labels.decide(agent),
          view,
          if count == 2 then layout.heading(1 - agent, place(2)) else 0,
          layout.heading(agent, place(3)),
          layout.heading(agent, place(4))
        )
      case TimetableKernel.SCORE => Array(labels.score, view)
      case other                 => throw IllegalArgumentException(s"no GPU knows operations of kind $other")

private[lanes] object GpuTimetable:
  /** Numbers of what a kernel does at an operation. */
  final class Labels(vehicles: Int):
    def look(vehicle: Int, withVelocity: Boolean): Int = if withVelocity then vehicles + vehicle else vehicle
    def act(vehicle: Int): Int                         = 2 * vehicles + vehicle
    def decide(vehicle: Int): Int                      = 3 * vehicles + vehicle
    def score: Int                                     = 4 * vehicles
    def show: Int                                      = score + 1

    /** A prediction begins, goes on under a command, and ends. */
    def predict(vehicle: Int): Int   = show + 1 + vehicle
    def carry(vehicle: Int): Int     = predict(vehicles + vehicle)
    def predicted(vehicle: Int): Int = carry(vehicles + vehicle)

    def count: Int = predicted(vehicles)

/** What a [[GpuTimetable]] tells of the present operation, in a kernel: words that are the same for all
  * threads of a block.
  *
  * @param base the register of its address
  * @param views the same of the views
  */
private[lanes] final class GpuRecord(code: Ptx, base: Int, views: Int):
  /** One of the operation's fields, from 1 on. */
  def field(number: Int): Int = code.loadWhole(base, number)

  /** Where in own memory one of the operation's things is. */
  def place(number: Int): Int = code.own(field(number))

  /** One of its times; see [[Timetable.times]]. */
  def time(number: Int): Int = code.load(base, Timetable.Fields + number)

  /** Where in own memory the operation's view has a vehicle's reading. */
  def seen(): Int => Int =
    val view  = code.address(views, field(1))
    val known = collection.mutable.HashMap.empty[Int, Int]
    vehicle => known.getOrElseUpdate(vehicle, code.own(code.loadWhole(view, vehicle)))
