package skein.loop

import skein.policy.Action
import skein.units.*

/** What was decided for one vehicle, and what from.
  *
  * @param sequence counts the decisions for this vehicle
  * @param view what the controller knew
  * @param opponent whom it was decided against
  * @param headingBefore commanded last to this vehicle
  * @param elapsed since this vehicle's last decision; zero at the first
  * @param heading the one chosen
  * @param speed the one chosen; absent where the vehicle always commands its own
  * @param action what was decided to do; absent where it is told by heading and speed at the altitude of the
  *   start
  */
final case class Decision(
    vehicle: Int,
    sequence: Long,
    decidedAt: Instant,
    view: TeamView,
    opponent: Int,
    headingBefore: Radians,
    elapsed: Span,
    heading: Radians,
    speed: Option[MetresPerSecond],
    action: Option[Action] = None
):
  /** As the other vehicles' policies see it, once it was sent. */
  def move(sentAt: Instant): SentCommand =
    SentCommand(vehicle, sequence, heading.value, sentAt, speed, action)
