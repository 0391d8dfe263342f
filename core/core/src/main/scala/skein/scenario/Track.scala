package skein.scenario

import java.util.Locale
import skein.policy.Role
import skein.units.*

/** The track of one vehicle, on the simulator's clock. Instants ascend, each occurs once, and there is at
  * least one.
  *
  * @param positionsNed position at each instant, m, world frame
  * @param velocitiesNed velocity at each instant, m/s
  * @param isMeasured whether velocities were measured; otherwise they follow from the straight lines between
  *   positions
  */
final case class Track private (
    vehicle: String,
    role: String,
    times: Vector[Instant],
    positionsNed: Vector[Vector3],
    velocitiesNed: Vector[Vector3],
    isMeasured: Boolean
):
  def from: Instant = times.head
  def to: Instant   = times.last

  def isA(role: Role): Boolean = Role.parse(this.role) == role

  /** The position at a time, m. Between samples it lies on a straight line: a vehicle that circles at 10 m/s
    * with a radius of 8 m, sampled every 100 ms, is less than 2 cm from it. Between samples with measured
    * velocities that are more than [[Track.LongGap]] apart, as around an outage, it lies on the Hermite cubic
    * through both positions and velocities: over 2 s, that circle is less than 1 m from the cubic, and 5.5 m
    * from the straight line. Outside the track's times it is the first or last position.
    */
  def at(time: Instant): Vector3 = sought(time, positionsNed): above =>
    if isMeasured && times(above).since(times(above - 1)) > Track.LongGap then curved(above, time)
    else straight(above, time, positionsNed)

  /** The velocity at a time, m/s, interpolated linearly between samples; outside the track's times the first
    * or last.
    */
  def velocityAt(time: Instant): Vector3 = sought(time, velocitiesNed)(straight(_, time, velocitiesNed))

  /** The value at a time.
    *
    * @param between interpolates, from the index of the sample after the time, which is not the first
    */
  private def sought(time: Instant, values: Vector[Vector3])(between: Int => Vector3): Vector3 =
    val above = times.search(time).insertionPoint
    if above == 0 then values.head
    else if above == times.size then values.last
    else between(above)

  private def straight(above: Int, time: Instant, values: Vector[Vector3]): Vector3 =
    values(above - 1) + (values(above) - values(above - 1)) * share(above, time)

  private def curved(above: Int, time: Instant): Vector3 =
    val gap      = times(above).since(times(above - 1)).toSeconds
    val s        = share(above, time)
    val (p, q)   = (positionsNed(above - 1), positionsNed(above))
    val (v, w)   = (velocitiesNed(above - 1) * gap, velocitiesNed(above) * gap)
    val (s2, s3) = (s * s, s * s * s)
    p + (q - p) * (3 * s2 - 2 * s3) + v * (s3 - 2 * s2 + s) + w * (s3 - s2)

  private def share(above: Int, time: Instant): Double =
    time.since(times(above - 1)).toSeconds / times(above).since(times(above - 1)).toSeconds

object Track:
  /** Gap between samples above which the track is a curve: five periods of the usual ten readings per second.
    */
  val LongGap: Span = Span.ofMillis(500)

  /** A track from samples.
    *
    * @param samples instant, position and velocity, in any order; if several have one instant, the first is
    *   used
    */
  def of(vehicle: String, role: String, samples: Vector[(Instant, Vector3, Vector3)]): Track =
    val ordered = samples.distinctBy(_._1).sortBy(_._1)
    Track(
      vehicle,
      role.toLowerCase(Locale.ROOT),
      ordered.map(_._1),
      ordered.map(_._2),
      ordered.map(_._3),
      isMeasured = true
    )

  /** A track without measured velocities: the velocity at a sample is that of the parabola through it and its
    * neighbours; at both ends, of the straight line to the neighbour.
    */
  def ofPositions(vehicle: String, role: String, samples: Vector[(Instant, Vector3)]): Track =
    val ordered = samples.distinctBy(_._1).sortBy(_._1)
    val lines   = ordered.zip(ordered.drop(1)).map { case ((from, start), (to, end)) =>
      val tookS = to.since(from).toSeconds
      (tookS, (end - start) * (1 / tookS))
    }
    val within = lines.zip(lines.drop(1)).map { case ((beforeS, before), (afterS, after)) =>
      (before * afterS + after * beforeS) * (1 / (beforeS + afterS))
    }
    val velocities =
      if lines.isEmpty then Vector(Vector3.Zero) else lines.head._2 +: within :+ lines.last._2
    of(vehicle, role, ordered.zip(velocities).map { case ((at, place), velocity) => (at, place, velocity) })
      .copy(isMeasured = false)
