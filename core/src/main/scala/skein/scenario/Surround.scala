package skein.scenario

import skein.policy.*

/** Pursuers close a ring around an evader, which flees from the nearest of them.
  *
  * @param vehicles
  *   the evader included
  * @param ringM
  *   radius of the ring
  * @param startM
  *   from the pursuers' line to the evader, at the start
  */
final case class Surround(
    vehicles: Int = 6,
    ringM: Double = 8,
    pursuerMps: Double = 8,
    evaderMps: Double = 4,
    startM: Double = 30,
    altitudeM: Double = 5
) extends Scenario:
  import Surround.*

  override def mistakes: Seq[String] =
    Scenario.outside("vehicles", vehicles, 3, AtOneAltitude.MostVehicles).toSeq ++ Scenario.notPositive(this)

  def agents: Vector[Agent] =
    val evader =
      AtOneAltitude.agent("Evader", Role.Evader, evaderMps, startM, 0, altitudeM, 0, Flee(evaderMps))
    val policy   = Surrounding(0, ringM, pursuerMps)
    val pursuers = Vector.tabulate(vehicles - 1): pursuer =>
      val eastM = (pursuer - (vehicles - 2) / 2.0) * ringM / 2
      AtOneAltitude.agent(s"Pursuer${pursuer + 1}", Role.Pursuer, pursuerMps, 0, eastM, altitudeM, 0, policy)
    evader +: pursuers

  override def series: Vector[Series] =
    Vector(Series("off the ring, rms", "m")(tracks => instant => offRingM(ringM, tracks, instant to instant)))

  override def measures: Vector[Measure] =
    val last                                                            = Window.Last(10)
    def over(name: String, unit: String)(of: (Tracks, Range) => Double) =
      Measure(name, unit)(tracks => last.of(tracks).map(of(tracks, _)))
    Vector(
      over("off ring", "m")(offRingM(ringM, _, _)),
      over("ring", "m")((tracks, range) => mean(range.map(meanDistanceM(tracks, _)))),
      over("nearest", "m")((tracks, range) => range.map(distancesM(tracks, _).min).min),
      over("gap", "°")((tracks, range) => mean(range.map(gapDeg(tracks, _)))),
      Measure("surrounded after", "s")(surroundedFromS)
    )

  override def note: String =
    s"Over the last 10 s: how far the pursuers are from the ring of $ringM m, root mean square; their mean distance to " +
      "the evader, the smallest, and the mean of the largest angle between neighbours as the evader sees them " +
      s"(${(360.0 / (vehicles - 1)).round}° is even); surrounded: from when on no such angle reaches 180°."

object Surround:

  /** Of the pursuers from the evader, the first vehicle, m. */
  private def distancesM(tracks: Tracks, instant: Int) =
    tracks.vehicles.tail.map(tracks.distanceM(0, _, instant))

  private def meanDistanceM(tracks: Tracks, instant: Int): Double = mean(distancesM(tracks, instant))

  /** Root mean square of how far the pursuers are from the ring, m. */
  private def offRingM(ringM: Double, tracks: Tracks, over: Range): Double =
    math.sqrt(mean(over.flatMap(distancesM(tracks, _)).map(_ - ringM).map(off => off * off)))

  /** The largest angle between neighbouring pursuers, as the evader sees them, degrees. */
  private def gapDeg(tracks: Tracks, instant: Int): Double =
    val bearings = tracks.vehicles.tail
      .map(pursuer =>
        StrictMath.atan2(
          tracks.eastM(pursuer)(instant) - tracks.eastM(0)(instant),
          tracks.northM(pursuer)(instant) - tracks.northM(0)(instant)
        )
      )
      .sorted
    bearings.zip(bearings.tail :+ (bearings.head + 2 * math.Pi)).map((one, next) => next - one).max.toDegrees

  /** From when on the evader stays between its pursuers, s: no gap reaches 180° any more. */
  private def surroundedFromS(tracks: Tracks): Option[Double] =
    val outside = tracks.instants.lastIndexWhere(gapDeg(tracks, _) >= 180)
    Option.when(outside < tracks.instants.last)(tracks.timeS(outside + 1))

  private def mean(values: Seq[Double]): Double = values.sum / values.size
