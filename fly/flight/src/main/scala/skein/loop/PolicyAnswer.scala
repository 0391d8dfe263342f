package skein.loop

import skein.policy.{Action, Agent}
import skein.units.OwnFailure

/** Evaluates a vehicle's policy and checks its answer. */
private object PolicyAnswer:

  /** The policy's initial memory.
    *
    * @throws OwnFailure if the policy throws
    */
  def first[A](agent: Agent)(memory: => A): A = OwnFailure.told(whose(agent))(memory)

  /** The policy's answer.
    *
    * @throws OwnFailure if the policy throws, or answers null
    */
  def of[A](agent: Agent)(answer: => A): A =
    Option(OwnFailure.told(whose(agent))(answer)).getOrElse(throw OwnFailure(whose(agent), "answered null"))

  /** Checks an action or a position.
    *
    * @throws OwnFailure if there is none, or a component is not finite
    */
  def expectAction(agent: Agent, action: Any): Unit =
    if !Action.isFinite(action) then
      throw OwnFailure(whose(agent), s"decided for what no vehicle can do: $action")

  private def whose(agent: Agent) = s"the policy of ${agent.name}"
