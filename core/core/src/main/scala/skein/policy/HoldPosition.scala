package skein.policy

/** Holds the vehicle's position; used when a policy does not answer. */
object HoldPosition extends Policy.Memoryless:

  def action(seen: Observation): Action = Action.Hover
