package skein.policy

/** Stays where it is: used where a policy does not answer. */
object HoldPosition extends AgentPolicy:
  type Memory = Unit

  def start: Unit = ()

  def choose(seen: Observation, memory: Unit): (Action, Unit) = (Action.Hover, ())
