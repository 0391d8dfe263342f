package skein.lanes

/** Where a thread of a GPU keeps what its vehicles' readings and headings are: words of its own memory.
  *
  * @param readings places of one vehicle
  * @param headings the same
  */
private[lanes] final case class GpuLayout(vehicles: Int, readings: Int, headings: Int):
  import LaneObservation.READ
  private val firstHeading = vehicles * readings * READ

  def bytes: Int = 4 * (firstHeading + 2 * vehicles * headings)

  /** Where a reading begins, bytes. */
  def reading(vehicle: Int, place: Int): Int = 4 * READ * (vehicle * readings + place)

  /** Where a heading's cosine and sine are, bytes. */
  def heading(vehicle: Int, place: Int): Int = 4 * (firstHeading + 2 * (vehicle * headings + place))

  /** One with room for an episode, too. */
  def holding(timetable: Timetable): GpuLayout =
    def doubled(now: Int, needed: Int) = if needed <= now then now else Integer.highestOneBit(needed * 2 - 1)
    copy(readings = doubled(readings, timetable.readings), headings = doubled(headings, timetable.headings))

/** A duel's [[Timetable]] as [[GpuDuelKernel]] reads it: of each operation [[stride]] words, the number of
  * its label, where in own memory are what it takes and leaves, and its times.
  */
private[lanes] final class GpuTimetable(timetable: Timetable, layout: GpuLayout):
  import GpuTimetable.*
  require(layout.holding(timetable) == layout, s"$layout has no room for ${timetable.readings} readings")

  val stride: Int = (FirstTime + timetable.numbers + 3) / 4 * 4
  def size: Int   = timetable.size

  val words: Array[Int] =
    // The kernel looks at the next operation's label while it is at the last.
    val packed = Array.ofDim[Int](size * stride + 1)
    for i <- 0 until size do
      val at     = i * stride
      val fields = record(i * Timetable.Fields)
      System.arraycopy(fields, 0, packed, at, fields.length)
      for number <- 0 until timetable.numbers do
        packed(at + FirstTime + number) =
          java.lang.Float.floatToRawIntBits(timetable.times(i * timetable.numbers + number))
    packed

  /** When it is scored, s. */
  val scoredAtS: Array[Float] =
    Array.range(0, size).filter(i => kind(i * Timetable.Fields) == TimetableKernel.SCORE).map(i =>
      timetable.times(i * timetable.numbers)
    )

  private def kind(at: Int) = timetable.operations(at)

  private def record(at: Int): Array[Int] =
    val agent              = timetable.operations(at + 1)
    def place(i: Int)      = timetable.operations(at + 1 + i)
    def seen(vehicle: Int) = layout.reading(vehicle, timetable.views(layout.vehicles * place(1) + vehicle))
    kind(at) match
      case TimetableKernel.LOOK =>
        Array((if place(2) != 0 then LookAtAll else Look) + agent, layout.reading(agent, place(1)))
      case TimetableKernel.ACT    => Array(Act + agent, layout.heading(agent, place(1)))
      case TimetableKernel.DECIDE =>
        val other = 1 - agent
        Array(
          Decide + agent,
          seen(agent),
          seen(other),
          layout.heading(other, place(2)),
          layout.heading(agent, place(3)),
          layout.heading(agent, place(4))
        )
      case TimetableKernel.SCORE => Array(Score, seen(0), seen(1))
      case other                 => throw IllegalArgumentException(s"no GPU knows operations of kind $other")

private[lanes] object GpuTimetable:
  // Labels; all but the last by vehicle.
  val Look: Int      = 0
  val LookAtAll: Int = 2
  val Act: Int       = 4
  val Decide: Int    = 6
  val Score: Int     = 8

  val Labels: Int = 9

  /** The first word of an operation's times. */
  val FirstTime: Int = Timetable.Fields

/** What a [[GpuTimetable]] tells of the present operation, in a kernel: words that are the same for all
  * threads of a block.
  *
  * @param base the register of its address
  */
private[lanes] final class GpuRecord(code: skein.gpu.Ptx, base: Int):
  /** Where in own memory one of the operation's things is; from 1 on. */
  def place(number: Int): Int = code.own(code.loadWhole(base, number))

  /** One of its times; see [[Timetable.times]]. */
  def time(number: Int): Int = code.load(base, GpuTimetable.FirstTime + number)
