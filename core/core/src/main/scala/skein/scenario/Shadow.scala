package skein.scenario

import skein.policy.*
import skein.units.Decimals.significant

/** A follower keeps a place beside a leader that turns left and right without notice. Its success depends on
  * its knowledge of both positions at the time its commands act.
  *
  * @param leaderMps speed of the leader
  * @param turnRadps turn rate of the leader, rad/s
  * @param leastS shortest time between two changes of the leader's turn, s
  * @param mostS longest time between two changes, s
  * @param course number of the leader's course; each number has different times
  * @param besideM distance of the place from the leader, to the east
  * @param mostMps maximum commanded speed of the follower
  * @param altitudeM altitude of both vehicles
  */
final case class Shadow(
    leaderMps: Double = 6,
    turnRadps: Double = 0.8,
    leastS: Double = 1,
    mostS: Double = 4,
    course: Int = 1,
    besideM: Double = 5,
    mostMps: Double = 12,
    altitudeM: Double = 20
) extends Scenario:
  import Shadow.*

  override def mistakes: Seq[String] =
    Scenario.notPositive(this, "course") ++
      Option.when(leastS > mostS)(s"leastS: expected mostS ($mostS) or less, got $leastS")

  def agents: Vector[Agent] =
    val weave = Weave(leaderMps, turnRadps, leastS, mostS, course)
    val keep  = Shadowing(0, 0, besideM, mostMps)
    Vector(
      AtOneAltitude.agent("Leader", Role.Leader, leaderMps, 0, 0, altitudeM, 0, weave),
      AtOneAltitude.agent("Follower", Role.Follower, leaderMps, 0, besideM, altitudeM, 0, keep)
    )

  override def series: Vector[Series] = Vector(offPlace)

  override def measures: Vector[Measure] =
    val settled = Window.After(SettlingS)
    Vector(offPlace.rms("off place", settled), offPlace.most("largest", settled))

  override def note: String =
    s"Off place: distance of the follower to its place, ${besideM.significant(3)} m east of the leader, after " +
      s"the first ${SettlingS.significant(3)} s: root mean square, and the largest."

  private def offPlace = Series.of("off the place", "m", Beside(besideM))

object Shadow:
  /** Time in which the follower gains speed after the start, s; measures leave it out. */
  private val SettlingS = 5.0

  /** Horizontal distance of the second vehicle from the place `eastM` east of the first, m. */
  final case class Beside(eastM: Double) extends Quantity:
    def of(positions: Positions): Double =
      positions.distanceM(1, positions.northM(0), positions.eastM(0) + eastM)
