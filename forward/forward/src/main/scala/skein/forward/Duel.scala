package skein.forward

import skein.policy.{Fleet, Role}
import skein.scenario.PaperDuel

/** A duel of one pursuer and one evader.
  *
  * @param durationS duration of an episode
  */
final case class Duel(pursuer: RolloutAgent, evader: RolloutAgent, durationS: Double = 60.0)

object Duel:
  /** The duel of a scenario with one pursuer and one evader. */
  def of(fleet: Fleet, durationS: Double = 60.0): Duel =
    require(fleet.agents.size == 2, s"a duel has two agents, this fleet ${fleet.agents.size}")
    def the(role: Role) =
      RolloutAgent.of(fleet.agents.find(_.role == role).get)
    Duel(the(Role.Pursuer), the(Role.Evader), durationS)

  val paper: Duel = of(PaperDuel().fleet)

  /** The paper's duel, moved to another altitude. */
  def paperAt(altitudeM: Double, durationS: Double): Duel =
    of(PaperDuel(altitudeM = altitudeM).fleet, durationS)

/** The outcome of an episode. Distances are horizontal, taken once a period.
  *
  * @param captureS time when the distance first was at most the capture radius; infinite if never
  * @param pursuerEffortRad control effort: the sum of all changes of the commanded heading, by the shorter
  *   way
  * @param evaderEffortRad control effort of the evader
  * @param decisions number of decisions of both agents
  * @param skipped number of views that a newer one replaced before the agent decided on them
  */
final case class DuelOutcome(
    minDistanceM: Double,
    minDistanceAtS: Double,
    meanDistanceM: Double,
    meanLast10sM: Double,
    captureS: Double,
    pursuerEffortRad: Double,
    evaderEffortRad: Double,
    decisions: Int,
    skipped: Int
)

/** The outcome of an episode for one evader. Distances are to the nearest pursuer, once a period.
  *
  * @param captureS time when the distance first was at most the capture radius; infinite if never
  */
final case class EvaderOutcome(
    minDistanceM: Double,
    minDistanceAtS: Double,
    meanDistanceM: Double,
    meanLast10sM: Double,
    captureS: Double
)
