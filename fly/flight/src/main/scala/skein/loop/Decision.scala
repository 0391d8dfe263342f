package skein.loop

import skein.policy.Action
import skein.port.CommandPlan
import skein.units.*

/** A decision for one vehicle, with its inputs.
  *
  * @param sequence index of the decision among this vehicle's decisions
  * @param view the controller's knowledge
  * @param opponent index of the vehicle that the decision is against
  * @param headingBefore heading of the last command to this vehicle
  * @param elapsed time since this vehicle's previous decision; zero at the first
  * @param action the chosen action
  * @param plan this decision's action and the predicted later ones, if one command carries them all
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
  /** The resulting heading, which other vehicles observe as the last commanded heading. */
  def heading: Radians = Radians(action.headingRad(headingBefore.value))

  /** The action as vehicles perform it. */
  def performed: Action = action.byVelocity

  /** The sent command as other vehicles' policies observe it. */
  def move(sentAt: Instant): SentCommand = SentCommand(vehicle, sequence, heading, sentAt, action)
