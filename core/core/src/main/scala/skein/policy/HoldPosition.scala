package skein.policy

/** Holds the vehicle's position; used when a policy does not answer. */
object HoldPosition extends Policy:
  type Memory = Unit

  def start: Unit = ()

  def choose(seen: Observation, memory: Unit): (Action, Unit) = (Action.Hover, ())
