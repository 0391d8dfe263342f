package skein.forward

import skein.policy.{Assignment, Role}
import skein.scenario.PaperDuel

/** One pursuer and one evader, which is read first.
  *
  * @param durationS of an episode
  */
final case class Pair(pursuer: RolloutAgent, evader: RolloutAgent, durationS: Double = 60.0):
  def engagement: Engagement = Engagement(
    Vector(evader, pursuer),
    Vector(Role.Evader, Role.Pursuer),
    Assignment(Vector(Vector(1), Vector(0))),
    durationS
  )

object Pair:
  /** Those of the paper's game. */
  val paper: Pair = at(PaperDuel.AltitudeM)

  /** Those of the paper's game, at another altitude. */
  def at(altitudeM: Double, durationS: Double = 60): Pair =
    val Vector(evader, pursuer) = PaperDuel(altitudeM = altitudeM).agents.map(RolloutAgent.of): @unchecked
    Pair(pursuer, evader, durationS)
