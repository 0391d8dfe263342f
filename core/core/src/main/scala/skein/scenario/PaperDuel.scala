package skein.scenario

import skein.policy.*
import skein.units.*

/** The paper's duel: a pursuer at 10 m/s behind an evader at 5 m/s, both at rest 21 m apart. Several duels
  * fly next to each other, 60 m apart; measures are those of the first.
  *
  * @param pairs number of duels; if there are several, their vehicles' names are numbered from 1
  * @param asPublished whether the pursuer turns by a fixed angle per decision, as in the published code,
  *   instead of at a fixed rate
  * @param altitudeM altitude of all vehicles
  */
final case class PaperDuel(
    pairs: Int = 1,
    asPublished: Boolean = false,
    altitudeM: Double = PaperDuel.AltitudeM
) extends Scenario:
  override def name: String  = PaperDuel.Name
  override def title: String = name + (if asPublished then ", as published" else "")

  override def mistakes: Seq[String] =
    Scenario.outside("pairs", pairs, 1, 50).toSeq ++ Scenario.notPositive(this)

  def agents: Vector[Agent] =
    val pursuer = if asPublished then PaperPursuer.asPublished else PaperPursuer()
    for
      pair <- (0 until pairs).toVector
      number       = if pairs == 1 then "" else (pair + 1).toString
      place        = Vector3(0, 60.0 * pair, 0)
      evaderStart  = Vector3(21, 0, -altitudeM) + place
      pursuerStart = Vector3(0, 0, -altitudeM) + place
      // The evader's initial heading is cos(0.5) in the published code, where 0.5 may have been meant.
      evaderHeading = Radians(StrictMath.cos(0.5))
      agent <- Vector(
        Agent(s"Evader$number", Role.Evader, MetresPerSecond(5), evaderStart, evaderHeading, PaperEvader()),
        Agent(s"Pursuer$number", Role.Pursuer, MetresPerSecond(10), pursuerStart, Radians(0), pursuer)
      )
    yield agent

  override def series: Vector[Series] = Vector(PaperDuel.distance)

  override def measures: Vector[Measure] =
    val last = Window.Last(10)
    Vector(
      PaperDuel.distance.mean("last 10 s", last),
      PaperDuel.distance.sd("sd", last),
      PaperDuel.distance.least("closest"),
      PaperDuel.distance.leastAt("at")
    ).map(_.ofFirst(2))

  override def isPapersGame: Boolean  = altitudeM == PaperDuel.AltitudeM
  override def isAsPublished: Boolean = asPublished

  override def note: String = "Horizontal distance between pursuer and evader."

  /** The setting's name without the scenario's name as a prefix, because recordings of duels are older than
    * those of other scenarios.
    */
  override def recordedAs(setting: String): String = setting

  override def crowded(vehicles: Int): PaperDuel = copy(pairs = pairs.max(vehicles / 2))

object PaperDuel:
  val Name = "duel"

  val AltitudeM = 20.0

  private val distance =
    Series.of("distance", "m", Apart(1, 0))
