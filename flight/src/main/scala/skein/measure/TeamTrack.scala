package skein.measure

import skein.units.*

/** Where the vehicles of a team were at equal instants of the simulator's clock, by vehicle and instant.
  *
  * @param northM
  *   m, world frame
  */
final case class TeamTrack private (
    stepS: Double,
    northM: Vector[Array[Double]],
    eastM: Vector[Array[Double]]
):

  def vehicles: Range = northM.indices

  def instants: Range = northM.head.indices

  /** Since all were first seen, s. */
  def timeS(instant: Int): Double = instant * stepS

  def distanceM(one: Int, other: Int, instant: Int): Double =
    StrictMath.hypot(
      northM(one)(instant) - northM(other)(instant),
      eastM(one)(instant) - eastM(other)(instant)
    )

  def distanceM(vehicle: Int, north: Double, east: Double, instant: Int): Double =
    StrictMath.hypot(northM(vehicle)(instant) - north, eastM(vehicle)(instant) - east)

  /** A value at every instant, with its time, s. */
  def curve(value: Int => Double): Vector[(Double, Double)] =
    instants.toVector.map(instant => (timeS(instant), value(instant)))

  /** Instants of the last 10 s; absent where there are not as many. */
  def lastTenSeconds: Option[Range] =
    val many = (10 / stepS).toInt
    Option.when(instants.size >= 0.95 * many)(instants.drop(instants.size - 1 - many max 0))

  /** How far the vehicles were from where those of another flight were at the same time since the start: root of the mean
    * square over vehicles and instants, horizontal, m.
    */
  def rmsFrom(other: TeamTrack): Double =
    val both    = instants.take(other.instants.size)
    val squares =
      for
        vehicle <- vehicles.iterator
        instant <- both.iterator
        away = distanceM(vehicle, other.northM(vehicle)(instant), other.eastM(vehicle)(instant), instant)
      yield away * away
    math.sqrt(squares.sum / (vehicles.size * both.size))

object TeamTrack:
  private val step = Span.ofMillis(20)

  /** Over the time for which all tracks run; none if there is no such time. */
  def of(tracks: Vector[Track]): Option[TeamTrack] =
    val from = tracks.map(_.from).maxOption
    val to   = tracks.map(_.to).minOption
    from.zip(to).filter(_ < _).map: (from, to) =>
      val count  = (to.since(from).toNanos / step.toNanos + 1).toInt
      val places = tracks.map(track => Vector.tabulate(count)(index => track.at(from + step * index)))
      TeamTrack(step.toSeconds, places.map(_.map(_.x).toArray), places.map(_.map(_.y).toArray))
