package skein.measure

import skein.policy.TeamScenario

/** What a team's flight came to.
  *
  * @param measures
  *   the first one stands for the flight when it is compared with others
  * @param curve
  *   of `curveName` over time: seconds since all were first seen, and metres
  * @param bound
  *   that the curve is held to, m
  */
final case class TeamResult(
    scenario: TeamScenario,
    track: TeamTrack,
    measures: Vector[Measure],
    curveName: String,
    curve: Vector[(Double, Double)],
    bound: Option[Double]
)

/** One number of a flight.
  *
  * @param name
  *   with its unit
  * @param value
  *   absent where it never came to it
  * @param isCount
  *   of events
  */
final case class Measure(name: String, value: Option[Double], isCount: Boolean = false)
