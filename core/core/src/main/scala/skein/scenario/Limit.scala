package skein.scenario

import skein.units.*
import skein.units.Decimals.significant

/** A condition of the flight: a quantity of some vehicles must stay at or above a value, or at or below it.
  *
  * @param name the limit's name, for example `separation`
  * @param groups yields, for the range of all vehicles' indices, the groups to which the limit applies
  * @param kept the part of the limit that plans observe, if any
  * @param quantity value for a group at an instant
  */
final class Limit private (
    val name: String,
    val unit: String,
    val value: Double,
    val isLeast: Boolean,
    groups: Range => Vector[Vector[Int]],
    val kept: Option[Kept],
    quantity: (Tracks, Vector[Int]) => Int => Double
):
  /** The limit in words, for example `separation of at least 5 m`. */
  def text: String =
    s"$name of at ${if isLeast then "least" else "most"} ${Limit.brief(value)} $unit".trim

  /** All stretches of time in which the limit was violated, group by group. */
  def violations(tracks: Tracks): Vector[Violation] =
    groups(tracks.vehicles).flatMap: group =>
      val of = quantity(tracks, group)
      stretches(tracks.instants, instant => isBroken(of(instant))).map: (first, last) =>
        val worst = (first to last).map(instant => (of(instant), instant)).reduce: (one, other) =>
          if if isLeast then other._1 < one._1 else other._1 > one._1 then other else one
        Violation(this, group, tracks.timeS(first), tracks.timeS(last), worst._1, tracks.timeS(worst._2))

  private def isBroken(found: Double) = if isLeast then found < value else found > value

  private def stretches(instants: Range, holds: Int => Boolean): Vector[(Int, Int)] =
    val (found, open) = instants.foldLeft((Vector.empty[(Int, Int)], Option.empty[Int])):
      case ((found, open), instant) =>
        (open, holds(instant)) match
          case (None, true)         => (found, Some(instant))
          case (Some(first), false) => (found :+ (first, instant - 1), None)
          case _                    => (found, open)
    found ++ open.map((_, instants.last))

object Limit:

  def separation(least: Metres): Limit = apart(least)((tracks, a, b) => tracks.separationM(a, b, _))

  /** The horizontal separation between any two vehicles must be at least this. */
  def horizontalSeparation(least: Metres): Limit = apart(least)((tracks, a, b) => tracks.distanceM(a, b, _))

  /** Every vehicle must stay at or above this altitude above the origin. */
  def floor(altitude: Metres): Limit =
    single("altitude", "m", altitude.value, true, Some(Kept.Above(altitude.value)))((tracks, vehicle) =>
      tracks.altitudeM(vehicle, _)
    )

  /** Every vehicle must stay at or below this altitude above the origin. */
  def ceiling(altitude: Metres): Limit =
    single("altitude", "m", altitude.value, false, Some(Kept.Below(altitude.value)))((tracks, vehicle) =>
      tracks.altitudeM(vehicle, _)
    )

  /** Every vehicle's speed in space must be at most this. */
  def speed(most: MetresPerSecond): Limit =
    single("speed", "m/s", most.value, false, Some(Kept.NoFaster(most.value)))((tracks, vehicle) =>
      tracks.velocityNed(vehicle, _).norm
    )

  /** Every vehicle must stay in a circle, seen from above. */
  def geofence(north: Metres, east: Metres, radius: Metres): Limit =
    single(
      "distance from the geofence's middle",
      "m",
      radius.value,
      false,
      Some(Kept.Inside(Fence.Circle(north.value, east.value, radius.value)))
    )((tracks, vehicle) => tracks.distanceM(vehicle, north.value, east.value, _))

  /** Every vehicle must stay in a polygon, seen from above; the quantity is the vehicle's distance outside.
    *
    * @param corners north and east of each corner, in order around the polygon; at least three
    */
  def geofence(corners: Vector[(Metres, Metres)]): Limit =
    require(corners.sizeIs >= 3, s"a geofence has at least three corners, got ${corners.size}")
    val fence = Fence.Polygon(corners.map((north, east) => (north.value, east.value)))
    single("distance outside the geofence", "m", 0, false, Some(Kept.Inside(fence)))((tracks, vehicle) =>
      instant => fence.beyondM(tracks.northM(vehicle)(instant), tracks.eastM(vehicle)(instant)).max(0)
    )

  /** A quantity of every vehicle that must not fall below a value. */
  def least(name: String, unit: String, value: Double)(of: (Tracks, Int) => Int => Double): Limit =
    single(name, unit, value, true, None)(of)

  /** A quantity of every vehicle that must not rise above a value. */
  def most(name: String, unit: String, value: Double)(of: (Tracks, Int) => Int => Double): Limit =
    single(name, unit, value, false, None)(of)

  private def single(name: String, unit: String, value: Double, isLeast: Boolean, kept: Option[Kept])(
      of: (Tracks, Int) => Int => Double
  ): Limit =
    new Limit(
      name,
      unit,
      value,
      isLeast,
      _.toVector.map(Vector(_)),
      kept,
      (tracks, one) => of(tracks, one.head)
    )

  private def apart(least: Metres)(of: (Tracks, Int, Int) => Int => Double): Limit =
    new Limit(
      "separation",
      "m",
      least.value,
      true,
      pairs,
      Some(Kept.Apart(least.value)),
      (tracks, two) => of(tracks, two(0), two(1))
    )

  private def pairs(vehicles: Range) =
    for one <- vehicles.toVector; other <- (0 until one).toVector yield Vector(other, one)

  private def brief(value: Double): String =
    if value == StrictMath.rint(value) && value.abs < 1e9 then value.toLong.toString else value.significant(6)

/** A stretch of time in which a limit was violated.
  *
  * @param vehicles indices of the vehicles
  * @param fromS begin of the violation, since all vehicles were first read, s
  * @param worst worst value of the quantity, in the limit's unit, with its time
  */
final case class Violation(
    limit: Limit,
    vehicles: Vector[Int],
    fromS: Double,
    toS: Double,
    worst: Double,
    worstAtS: Double
)

/** A part of a limit that plans observe, not only reports. */
enum Kept:
  /** Minimum distance between any two vehicles, in the plane, m. */
  case Apart(leastM: Double)
  case Inside(fence: Fence)

  case Above(leastM: Double)
  case Below(mostM: Double)

  case NoFaster(mostMps: Double)
