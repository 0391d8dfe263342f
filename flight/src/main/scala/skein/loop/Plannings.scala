package skein.loop

import skein.policy.{Fleet, GoalPolicy}

/** Who plans how. */
private object Plannings:

  /** How a vehicle's decisions are planned; absent where its policy decides.
    *
    * @param seed
    *   of the search's random numbers
    */
  def of(fleet: Fleet, self: Int, settings: PlanSettings, seed: Long): Option[Planning] =
    val agent = fleet.agents(self)
    Option.when(Planning.plans(agent)):
      agent.policy match
        case goal: GoalPolicy => TeamPlanning(fleet, self, goal, settings, seed)
        case _                => PursuitPlanning(fleet, self, settings, seed)
