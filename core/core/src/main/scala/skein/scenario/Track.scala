package skein.scenario

import java.util.Locale
import skein.policy.Role
import skein.units.*

/** The track of one vehicle by the simulator's clock; ascending, each instant once, at least one.
  *
  * @param positionsNed by instant, m, world frame
  * @param velocitiesNed by instant, m/s
  * @param isMeasured whether velocities were measured, and are not those of the straight ways
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

  /** On straight lines between samples. A vehicle that circles at 10 m/s on 8 m, sampled every 100 ms, is
    * less than 2 cm from them. Between samples with measured velocities more than [[Track.LongGap]] apart, as
    * around an outage, on the cubic through both positions and velocities (Hermite's): that circle is then
    * less than 1 m from it over 2 s, and 5.5 m from the straight line. Outside the track's times, its first
    * or last position.
    */
  def at(time: Instant): Vector3 = sought(time, positionsNed): above =>
    if isMeasured && times(above).since(times(above - 1)) > Track.LongGap then curved(above, time)
    else straight(above, time, positionsNed)

  /** Interpolated velocity, m/s, on straight lines between samples; outside them as [[at]]. */
  def velocityAt(time: Instant): Vector3 = sought(time, velocitiesNed)(straight(_, time, velocitiesNed))

  /** The value at a time.
    *
    * @param between given the index of the sample after the time, which is not the first
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
  /** Samples further apart have curves between them: five periods of the usual ten readings a second. */
  val LongGap: Span = Span.ofMillis(500)

  /** A track of samples.
    *
    * @param samples instant, position and velocity, in any order; of one instant the first counts
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

  /** A track without measured velocities: each velocity is that of the straight way to the next sample. */
  def ofPositions(vehicle: String, role: String, samples: Vector[(Instant, Vector3)]): Track =
    val ordered = samples.distinctBy(_._1).sortBy(_._1)
    val moved   = ordered.zip(ordered.drop(1)).map { case ((from, start), (to, end)) =>
      (end - start) * (1 / to.since(from).toSeconds)
    }
    val velocities = if moved.isEmpty then Vector(Vector3.Zero) else moved :+ moved.last
    of(vehicle, role, ordered.zip(velocities).map { case ((at, place), velocity) => (at, place, velocity) })
      .copy(isMeasured = false)
