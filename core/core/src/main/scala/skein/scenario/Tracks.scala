package skein.scenario

import skein.units.*

/** Positions of all vehicles of a flight at equidistant instants of the simulator's clock, indexed by vehicle
  * and instant. Vehicles are identified by their index in the scenario. World frame NED, m.
  */
final class Tracks private (
    tracks: Vector[Track],
    from: Instant,
    val northM: Vector[Array[Double]],
    val eastM: Vector[Array[Double]],
    val downM: Vector[Array[Double]]
):

  def vehicles: Range = northM.indices

  def instants: Range = northM.head.indices

  /** Time between two successive instants of the tracks, s. */
  def stepS: Double = Tracks.step.toSeconds

  def timeS(instant: Int): Double = instant * stepS

  def lastS: Double = timeS(instants.last)

  def positionNed(vehicle: Int, instant: Int): Vector3 =
    Vector3(northM(vehicle)(instant), eastM(vehicle)(instant), downM(vehicle)(instant))

  /** The tracks of only the first vehicles, over the time in which all of these were read. */
  def first(count: Int): Tracks = if count == vehicles.size then this else Tracks.of(tracks.take(count)).get

  def positions(instant: Int): Positions = places(instant)

  // Measures ask for them again and again: those of a crossing for each pair of its vehicles.
  private lazy val places = instants.map: instant =>
    def now(values: Vector[Array[Double]]) = IArray.from(values.map(_(instant)))
    Positions(now(northM), now(eastM), now(downM), timeS(instant))

  def velocityNed(vehicle: Int, instant: Int): Vector3 =
    tracks(vehicle).velocityAt(from + Tracks.step * instant)

  def altitudeM(vehicle: Int, instant: Int): Double = -downM(vehicle)(instant)

  /** Horizontal distance between two vehicles, m. */
  def distanceM(one: Int, other: Int, instant: Int): Double =
    StrictMath.hypot(
      northM(one)(instant) - northM(other)(instant),
      eastM(one)(instant) - eastM(other)(instant)
    )

  /** Horizontal distance from a vehicle to a position, m. */
  def distanceM(vehicle: Int, north: Double, east: Double, instant: Int): Double =
    StrictMath.hypot(northM(vehicle)(instant) - north, eastM(vehicle)(instant) - east)

  def separationM(one: Int, other: Int, instant: Int): Double =
    (positionNed(one, instant) - positionNed(other, instant)).norm

  /** Root mean square deviation from another flight at equal times since the start, over all vehicles and
    * instants, m.
    *
    * @param inSpace whether distances are in three dimensions; otherwise they are horizontal
    */
  def rmsFrom(other: Tracks, inSpace: Boolean): Double =
    val both    = instants.take(other.instants.size)
    val squares =
      for
        vehicle <- vehicles.iterator
        instant <- both.iterator
        away  = distanceM(vehicle, other.northM(vehicle)(instant), other.eastM(vehicle)(instant), instant)
        above = if inSpace then downM(vehicle)(instant) - other.downM(vehicle)(instant) else 0.0
      yield away * away + above * above
    math.sqrt(squares.sum / (vehicles.size * both.size))

object Tracks:
  private val step = Span.ofMillis(20)

  /** The tracks over the time that all of them cover; None if there is no such time. */
  def of(tracks: Vector[Track]): Option[Tracks] =
    val from = tracks.map(_.from).maxOption
    val to   = tracks.map(_.to).minOption
    from.zip(to).filter(_ < _).map: (from, to) =>
      val count     = (to.since(from).toNanos / step.toNanos + 1).toInt
      val positions = tracks.map(track => Vector.tabulate(count)(index => track.at(from + step * index)))
      Tracks(
        tracks,
        from,
        positions.map(_.map(_.x).toArray),
        positions.map(_.map(_.y).toArray),
        positions.map(_.map(_.z).toArray)
      )
