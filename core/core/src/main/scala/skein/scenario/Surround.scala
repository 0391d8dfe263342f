package skein.scenario

import skein.policy.*
import skein.units.Decimals.significant

/** Pursuers close a ring around an evader, which flees from the nearest of them.
  *
  * @param vehicles number of vehicles, the evader included
  * @param ringM radius of the ring
  * @param pursuerMps speed of the pursuers
  * @param evaderMps speed of the evader
  * @param startM distance from the pursuers' line to the evader at the start
  * @param altitudeM altitude of all vehicles
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

  private def offRing = Series.of("off the ring, rms", "m", OffRing(ringM))

  override def series: Vector[Series] = Vector(offRing)

  override def measures: Vector[Measure] =
    val last = Window.Last(10)
    Vector(
      offRing.rms("off ring", last),
      Series.of("ring", "m", MeanDistance).mean("ring", last),
      Series.of("nearest", "m", LeastDistance).least("nearest", last),
      gap.mean("gap", last),
      gap.staysBelow("surrounded after", 180)
    )

  override def note: String =
    s"Over the last 10 s: how far the pursuers are from the ring of ${ringM.significant(3)} m, root mean " +
      "square; their mean distance to the evader, the smallest, and the mean of the largest " +
      s"angle between neighbours as the evader sees them (${(360.0 / (vehicles - 1)).round}° " +
      "is even); surrounded: from when on no such angle reaches 180°."

object Surround:
  private val gap = Series.of("gap", "°", WidestGap)

  /** Mean horizontal distance of the pursuers from the evader, the first vehicle, m. */
  private case object MeanDistance extends Quantity:
    def of(positions: Positions): Double =
      var sum     = 0.0
      var pursuer = 1
      while pursuer < positions.count do
        sum += positions.distanceM(0, pursuer)
        pursuer += 1
      sum / (positions.count - 1)

  /** Horizontal distance of the nearest pursuer from the evader, m. */
  private case object LeastDistance extends Quantity:
    def of(positions: Positions): Double =
      var least   = Double.PositiveInfinity
      var pursuer = 1
      while pursuer < positions.count do
        least = least.min(positions.distanceM(0, pursuer))
        pursuer += 1
      least
