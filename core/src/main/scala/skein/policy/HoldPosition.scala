package skein.policy

/** Stays where it is: what a vehicle does whose policy is not heard of. */
object HoldPosition extends AgentPolicy:
  type Memory = Unit

  def start: Unit = ()

  def choose(seen: Observation, memory: Unit): (Action, Unit) = (Action.Hover, ())
