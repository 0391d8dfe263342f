package skein.port

import skein.policy.Action
import skein.units.*

/** Actions of one vehicle for several moments, sent in one command, so that it contains the right action
  * whenever it arrives.
  *
  * @param sequence number of the decision; of two plans, that with the greater number is in effect
  * @param actions the actions, each with the time from which it acts, on the vehicles' clock, ascending; at
  *   most [[CommandPlan.Most]]. The last action lasts for [[CommandPlan.Hold]]; then the vehicle holds its
  *   position. A plan without actions changes nothing and only tests whether plans are accepted
  */
final case class CommandPlan(sequence: Long, actions: Vector[(at: Instant, action: Action)]):
  for wrong <- CommandPlan.mistake(actions.map(_.at)) do
    throw IllegalArgumentException(s"a command's plan: $wrong")

object CommandPlan:
  /** Maximum number of actions of a plan, which fit into one packet of TCP. */
  final val Most = 16

  /** Duration of a plan's last action, after which the vehicle holds its position. */
  val Hold: Span = Span.ofSeconds(1)

  /** A plan without actions, which tests whether plans are accepted. */
  val Question: CommandPlan = CommandPlan(0, Vector.empty)

  /** The reason why a plan cannot have actions at these times; None if it can. */
  def mistake(moments: Seq[Instant]): Option[String] =
    if moments.size > Most then Some(s"expected at most $Most actions, got ${moments.size}")
    else if moments.zip(moments.drop(1)).exists((one, next) => one >= next) then
      Some("expected moments in ascending order, got others")
    else None
