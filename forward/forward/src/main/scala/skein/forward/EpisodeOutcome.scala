package skein.forward

/** The outcome of an episode. Distances are horizontal, taken once a period.
  *
  * @param captureS time when the distance first was at most the capture radius; infinite if never
  * @param pursuerEffortRad control effort: the sum of all changes of the commanded heading, by the shorter
  *   way
  * @param evaderEffortRad control effort of the evader
  * @param decisions number of decisions of both agents
  * @param skipped number of views that a newer one replaced before the agent decided on them
  */
final case class EpisodeOutcome(
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
