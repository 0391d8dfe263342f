package skein.lanes.gpu

import skein.lanes.timetable.{Propagation, Timetable}
import skein.lanes.timetable.TimetableKernel.{ACT, DECIDE, LOOK, PREDICT, SCORE}
import skein.units.eachBelow

/** Layout of each GPU thread's own memory, in bytes, with the readings and commands of its vehicles.
  *
  * @param readings number of slots for readings per vehicle
  * @param headings number of slots for commands per vehicle
  * @param shows whether several vehicles share computations on a view
  */
private[lanes] final case class GpuLayout(
    vehicles: Int,
    shows: Boolean,
    readings: Int = 4,
    headings: Int = 4
):
  import Timetable.Read
  private val firstHeading = 4 * Read * vehicles * readings

  /** Size of the layout; further data of a kernel follow it. */
  val bytes: Int = firstHeading + 8 * vehicles * headings

  def reading(vehicle: Int, place: Int): Int = 4 * Read * (vehicle * readings + place)

  /** Address of a command: a heading's cosine and sine, or a velocity. */
  def heading(vehicle: Int, place: Int): Int = firstHeading + 8 * (vehicle * headings + place)

  /** This layout, enlarged as needed for an episode. */
  def holding(timetable: Timetable): GpuLayout =
    def doubled(now: Int, needed: Int) = if needed <= now then now else Integer.highestOneBit(needed * 2 - 1)
    copy(readings = doubled(readings, timetable.readings), headings = doubled(headings, timetable.headings))

/** A [[Timetable]] in the format of [[GpuFlightKernel]]. Each operation has [[stride]] words: the number of
  * its label, the addresses of its inputs and outputs in the thread's own memory, and its times. Then follow
  * the views, each with the addresses of all vehicles' readings.
  */
private[lanes] final class GpuTimetable(timetable: Timetable, layout: GpuLayout):
  import GpuTimetable.*
  import Timetable.Fields
  require(layout.holding(timetable) == layout, s"$layout has no room for ${timetable.readings} readings")

  private val count  = layout.vehicles
  private val labels = Labels(count)

  val stride: Int =
    val most = timetable.propagations.iterator.map(GpuPrediction.mostNumbers).maxOption.getOrElse(0)
    (Fields + timetable.numbers.max(most) + 3) / 4 * 4

  // Offset of the present operation, all words so far, and their number of operations.
  private var at      = 0
  private var packed  = Array.ofDim[Int](stride * timetable.size)
  private var records = 0

  write()

  def size: Int = records

  val words: Array[Int] =
    val all = java.util.Arrays.copyOf(packed, records * stride + timetable.views.length)
    for i <- timetable.views.indices do
      all(records * stride + i) = layout.reading(i % count, timetable.views(i))
    all

  val scoredAtS: Array[Float] =
    Array
      .range(0, timetable.size)
      .filter(i => timetable.operations(i * Fields) == SCORE)
      .map(i => timetable.times(i * timetable.numbers))

  private def write(): Unit =
    var shown = Nothing
    eachBelow(timetable.size): i =>
      val kind = timetable.operations(i * Fields)
      val view = timetable.operations(i * Fields + 2)
      // Values that several vehicles compute from a view are computed once.
      if layout.shows && kind == DECIDE && view != shown then
        shown = view
        record(labels.show)
        field(1, count * view)
      if kind == PREDICT then predict(i) else operation(kind, i)

  private def record(label: Int): Unit =
    at = records * stride
    records += 1
    if packed.length < at + stride then packed = java.util.Arrays.copyOf(packed, 2 * (at + stride))
    packed(at) = label

  private def field(number: Int, value: Int): Unit = packed(at + number) = value

  private def time(number: Int, value: Float): Unit =
    packed(at + Fields + number) = java.lang.Float.floatToRawIntBits(value)

  private def operation(kind: Int, i: Int): Unit =
    val agent             = timetable.operations(i * Fields + 1)
    def place(field: Int) = timetable.operations(i * Fields + 1 + field)
    kind match
      case LOOK =>
        record(labels.look(agent, withVelocity = place(2) != 0))
        field(1, layout.reading(agent, place(1)))
      case ACT =>
        record(labels.act(agent))
        field(1, layout.heading(agent, place(1)))
      case DECIDE =>
        record(labels.decide(agent))
        field(1, count * place(1))
        if count == 2 then field(2, layout.heading(1 - agent, place(2)))
        field(3, layout.heading(agent, place(3)))
        field(4, layout.heading(agent, place(4)))
      case SCORE =>
        record(labels.score)
        field(1, count * place(1))
      case other => throw IllegalArgumentException(s"no GPU knows operations of kind $other")
    eachBelow(timetable.numbers): number =>
      time(number, timetable.times(i * timetable.numbers + number))

  private def predict(i: Int): Unit =
    val agent             = timetable.operations(i * Fields + 1)
    def place(field: Int) = layout.reading(agent, timetable.operations(i * Fields + 1 + field))
    val propagation       = timetable.propagations(timetable.operations(i * Fields + 4))
    record(labels.predict(agent))
    field(1, place(1))
    GpuPrediction.tellBegin(propagation, time)
    for (command, part) <- propagation.commands.zipWithIndex do
      record(labels.carry(agent))
      field(1, if command == Propagation.Rest then -1 else layout.heading(agent, command))
      GpuPrediction.tellPart(propagation, part, time)
    record(labels.predicted(agent))
    field(1, place(2))
    GpuPrediction.tellEnd(propagation, time)

private[lanes] object GpuTimetable:
  private val Nothing = -1

  /** Numbers of the kernel's labels, at which the code of each kind of operation begins. */
  final class Labels(vehicles: Int):
    def look(vehicle: Int, withVelocity: Boolean): Int = if withVelocity then vehicles + vehicle else vehicle
    def act(vehicle: Int): Int                         = 2 * vehicles + vehicle
    def decide(vehicle: Int): Int                      = 3 * vehicles + vehicle
    def score: Int                                     = 4 * vehicles
    def show: Int                                      = score + 1

    /** Labels of a prediction's start, of its continuation under a command, and of its end. */
    def predict(vehicle: Int): Int   = show + 1 + vehicle
    def carry(vehicle: Int): Int     = predict(vehicles + vehicle)
    def predicted(vehicle: Int): Int = carry(vehicles + vehicle)

    def count: Int = predicted(vehicles)
