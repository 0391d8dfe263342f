package skein.measure

import skein.policy.TeamScenario

/** How well an evader, the first vehicle, is surrounded by the others. */
object SurroundMeasures:

  def apply(scenario: TeamScenario.Surround, track: TeamTrack): TeamResult =
    val last = track.lastTenSeconds
    TeamResult(
      scenario,
      track,
      Vector(
        Measure("off ring m", last.map(offRingM(scenario, track, _))),
        Measure("ring m", last.map(over => mean(over.map(meanDistanceM(track, _))))),
        Measure("nearest m", last.map(_.map(nearestM(track, _)).min)),
        Measure("gap °", last.map(over => mean(over.map(gapDeg(track, _))))),
        Measure("surrounded after s", surroundedFromS(track))
      ),
      "off the ring, rms",
      track.curve(instant => offRingM(scenario, track, instant to instant)),
      None
    )

  /** Of the pursuers from the evader, m. */
  def meanDistanceM(track: TeamTrack, instant: Int): Double =
    mean(track.vehicles.tail.map(track.distanceM(0, _, instant)))

  /** Root mean square of how far the pursuers are from the ring, m. */
  def offRingM(scenario: TeamScenario.Surround, track: TeamTrack, over: Range): Double =
    val squares =
      for
        instant <- over
        pursuer <- track.vehicles.tail
        off = track.distanceM(0, pursuer, instant) - scenario.ringM
      yield off * off
    math.sqrt(mean(squares))

  private def nearestM(track: TeamTrack, instant: Int): Double =
    track.vehicles.tail.map(track.distanceM(0, _, instant)).min

  /** The largest angle between neighbouring pursuers, as the evader sees them, degrees. */
  def gapDeg(track: TeamTrack, instant: Int): Double =
    val bearings = track.vehicles.tail
      .map(pursuer =>
        StrictMath.atan2(
          track.eastM(pursuer)(instant) - track.eastM(0)(instant),
          track.northM(pursuer)(instant) - track.northM(0)(instant)
        )
      )
      .sorted
    bearings.zip(bearings.tail :+ (bearings.head + 2 * math.Pi)).map((one, next) => next - one).max.toDegrees

  /** From when on the evader stays between its pursuers, s: no gap reaches 180° any more. */
  def surroundedFromS(track: TeamTrack): Option[Double] =
    val outside = track.instants.lastIndexWhere(gapDeg(track, _) >= 180)
    Option.when(outside < track.instants.last)(track.timeS(outside + 1))

  private def mean(values: Iterable[Double]): Double = values.sum / values.size
