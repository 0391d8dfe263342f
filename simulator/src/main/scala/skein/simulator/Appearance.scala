package skein.simulator

import scala.collection.mutable
import skein.airsim.wire.Vector3r
import skein.units.Instant

/** What only an eye would notice: weather, sun, markers, messages. AirSim draws it; here it is kept, for whoever will. All of
  * it is bounded, and what was dropped for newer is counted.
  */
final private[simulator] class Appearance:
  import Appearance.*

  /** Whether weather is drawn. */
  var weather = false

  /** Strengths by AirSim's number of the effect. */
  val effects: mutable.Map[Int, Float] = mutable.Map.empty

  /** None: the sun stands where the level has it. */
  var sun = Option.empty[Sun]

  /** By the vehicle's index. */
  val traces: mutable.Map[Int, Trace] = mutable.Map.empty

  /** Console commands, which nothing here carries out. */
  val commands: Newest[String] = Newest(MostLines)

  private val lines = mutable.LinkedHashMap.empty[String, Line]
  private var drawn = Vector.empty[Marker]
  private var lost  = 0L

  /** Messages by their first part, the oldest first. */
  def log: Seq[Line] = lines.valuesIterator.toSeq

  /** A message of the same first part as an earlier one takes its place. */
  def print(line: Line): Unit =
    if !lines.contains(line.message) && lines.size == MostLines then lines.subtractOne(lines.head._1): Unit
    lines(line.message) = line

  /** The markers to be seen at `at`. */
  def markers(at: Instant): Seq[Marker] = drawn.filter(_.until.forall(_ > at))

  /** Markers dropped because there were too many. */
  def droppedMarkers: Long = lost

  def draw(marker: Marker, at: Instant): Unit =
    drawn = markers(at).toVector :+ marker
    while drawn.size > MostMarkers || drawn.iterator.map(_.points.size.toLong).sum > MostPoints do
      drawn = drawn.tail
      lost += 1

  def flushPersistent(): Unit = drawn = drawn.filter(_.until.nonEmpty)

private[simulator] object Appearance:
  val MostLines   = 100
  val MostMarkers = 1000
  val MostPoints  = 100_000L

  final case class Sun(start: String, daylightSaving: Boolean, speed: Float, intervalS: Float, moves: Boolean)

  final case class Trace(colour: Seq[Float], thickness: Float)

  /** @param severity
    *   0 information, 1 success, 2 failure, 3 unimportant
    */
  final case class Line(message: String, parameter: String, severity: Int)

  /** @param kind
    *   the function that drew it
    * @param points
    *   world, NED, m
    * @param until
    *   when it vanishes; None: not by itself
    */
  final case class Marker(
      kind: String,
      points: Seq[Vector3r],
      texts: Seq[String],
      colour: Seq[Float],
      until: Option[Instant]
  )

  /** The newest of what came, and how many. */
  final class Newest[A](most: Int):
    private var kept = Vector.empty[A]
    private var all  = 0L

    def newest: Seq[A] = kept
    def count: Long    = all

    def add(value: A): Unit =
      kept = (kept :+ value).takeRight(most)
      all += 1
