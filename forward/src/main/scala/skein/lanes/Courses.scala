package skein.lanes

/** The ways by which a [[Timetable]]'s readings are carried forward: parts flown under one command each. What the numbers
  * mean, the kind of predicted vehicles says.
  *
  * @param starts
  *   of each course, its first part; and behind the last course the number of parts
  * @param firsts
  *   of each course, a number
  * @param seconds
  *   and another
  * @param places
  *   of each part, the place of the command, or [[Courses.Rest]]
  * @param spans
  *   of each part, a number
  * @param rests
  *   and another
  */
private[skein] final class Courses(
    starts: Array[Int],
    firsts: Array[Float],
    seconds: Array[Float],
    places: Array[Int],
    spans: Array[Float],
    rests: Array[Float]
):
  def isEmpty: Boolean           = starts.length <= 1
  def start(course: Int): Int    = starts(course)
  def end(course: Int): Int      = starts(course + 1)
  def first(course: Int): Float  = firsts(course)
  def second(course: Int): Float = seconds(course)
  def place(part: Int): Int      = places(part)
  def span(part: Int): Float     = spans(part)
  def rest(part: Int): Float     = rests(part)
  private[lanes] def bytes: Long = 4L * (starts.length * 3 + places.length * 3)

private[skein] object Courses:
  /** In the place of a command: none yet. */
  val Rest: Int = -1

/** One course before its commands have places. */
private[lanes] final case class Course(parts: Vector[Course.Part], first: Double = 0, second: Double = 0)

private[lanes] object Course:
  /** @param decision
    *   whose command acts; 0: none yet
    */
  final case class Part(decision: Int, span: Double, rest: Double)

  /** Puts courses one behind the other. */
  final class Builder:
    private val starts          = Array.newBuilder[Int].addOne(0)
    private val firsts, seconds = Array.newBuilder[Float]
    private val places          = Array.newBuilder[Int]
    private val spans, rests    = Array.newBuilder[Float]
    private var count, parts    = 0

    /** @param placeOf
      *   of a decision
      * @return
      *   its number
      */
    def add(course: Course, placeOf: Int => Int): Int =
      for part <- course.parts do
        places += (if part.decision == 0 then Courses.Rest else placeOf(part.decision))
        spans += part.span.toFloat
        rests += part.rest.toFloat
      parts += course.parts.size
      starts += parts
      firsts += course.first.toFloat
      seconds += course.second.toFloat
      count += 1
      count - 1

    def result(): Courses =
      Courses(
        starts.result(),
        firsts.result(),
        seconds.result(),
        places.result(),
        spans.result(),
        rests.result()
      )
