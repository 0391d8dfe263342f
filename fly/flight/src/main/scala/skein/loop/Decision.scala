package skein.loop

import skein.policy.Action
import skein.port.CommandPlan
import skein.units.*

/** A decision for one vehicle, with its inputs.
  *
  * @param sequence counts the decisions for this vehicle
  * @param view the controller's knowledge
  * @param opponent the vehicle against which it was decided
  * @param headingBefore heading of the last command to this vehicle
  * @param elapsed time since this vehicle's previous decision; zero at the first
  * @param action the chosen action
  * @param plan this decision's action and the foreseen ones after it, if one command sends them together
  */
final case class Decision(
    vehicle: Int,
    sequence: Long,
    decidedAt: Instant,
    view: TeamView,
    opponent: Int,
    headingBefore: Radians,
    elapsed: Span,
    action: Action,
    plan: Option[CommandPlan] = None
):
  /** The heading to which it leads; other vehicles observe it as the last commanded one. */
  def heading: Radians = Radians(action.headingRad(headingBefore.value))

  /** The action as vehicles perform it. */
  def performed: Action = action.byVelocity

  /** The sent command as other vehicles' policies observe it. */
  def move(sentAt: Instant): SentCommand = SentCommand(vehicle, sequence, heading, sentAt, action)
