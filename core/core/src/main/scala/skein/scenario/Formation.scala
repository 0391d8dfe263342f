package skein.scenario

import skein.policy.*
import skein.units.Decimals.significant

/** A wedge of vehicles flies a circuit of two straights joined by half turns. The leader is first; followers
  * are behind it, to the right and left in turn.
  *
  * @param vehicles number of vehicles, the leader included
  * @param spacingM distance from one slot to the next, backwards and sideways
  * @param leaderMps speed of the leader
  * @param mostMps maximum commanded speed of the followers
  * @param straightM length of each of the circuit's two straights
  * @param radiusM radius of the circuit's half turns
  * @param lagS time constant with which the policies expect vehicles to follow their commands; for AirSim's
  *   at low altitude about 1.5 s
  * @param altitudeM altitude of all vehicles
  */
final case class Formation(
    vehicles: Int = 5,
    spacingM: Double = 4,
    leaderMps: Double = 5,
    mostMps: Double = 10,
    straightM: Double = 50,
    radiusM: Double = 20,
    lagS: Double = 1.5,
    altitudeM: Double = 5
) extends Scenario:
  import Formation.*

  override def mistakes: Seq[String] =
    Scenario.outside("vehicles", vehicles, 2, AtOneAltitude.MostVehicles).toSeq ++
      Scenario.notPositive(this, "straightM", "lagS")

  def circuit: Racetrack = Racetrack(straightM, radiusM)

  /** The followers' slots in the leader's frame: distance ahead and to the right, m. */
  def slots: Vector[(Double, Double)] =
    Vector.tabulate(vehicles - 1): follower =>
      val rank = follower / 2 + 1
      val side = if follower % 2 == 0 then 1 else -1
      (-rank * spacingM, side * rank * spacingM)

  def agents: Vector[Agent] =
    val leading   = LeadOnCircuit(circuit, leaderMps, leaderMps * lagS)
    val leader    = AtOneAltitude.agent("Leader", Role.Leader, leaderMps, 0, 0, altitudeM, 0, leading)
    val followers = slots.zipWithIndex.map:
      case ((aheadM, rightM), follower) =>
        val policy = KeepSlot(0, circuit, aheadM, rightM, mostMps, lagS)
        val name   = s"Follower${follower + 1}"
        AtOneAltitude.agent(name, Role.Follower, leaderMps, aheadM, rightM, altitudeM, 0, policy)
    leader +: followers

  override def series: Vector[Series] =
    Vector(offSlots)

  override def measures: Vector[Measure] =
    val settled = Window.After(SettlingS)
    val largest = Series.of("largest", "m", FarthestOffSlot(errors))
    Vector(
      offSlots.rms("slot rms", settled),
      largest.most("largest", settled),
      largest.mostAt("at", settled)
    )

  override def note: String =
    "Distance of the followers to their slots after the first " +
      s"${SettlingS.significant(3)} s: root mean square, and the largest."

  private def offSlots = Series.of("slot error, rms", "m", errors)

  private def errors =
    val (ahead, right) = slots.unzip
    OffSlots(circuit, IArray.from(ahead), IArray.from(right))

object Formation:
  /** Time in which the vehicles gain speed after the start, s; measures leave it out. */
  private val SettlingS = 10.0
