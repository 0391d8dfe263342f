package skein.port

import skein.policy.Action
import skein.units.*

/** Actions of one vehicle for several moments, sent in one command. Whichever moment it arrives at, the
  * action of that moment is in it.
  *
  * @param sequence number of the decision: of two plans, the one with the greater number counts
  * @param actions with the moments from which they act, on the vehicles' clock, in ascending order; at most
  *   [[CommandPlan.Most]]. The last one acts for [[CommandPlan.Hold]], then the vehicle holds its position.
  *   Without any, a plan changes nothing: it only asks whether plans are accepted
  */
final case class CommandPlan(sequence: Long, actions: Vector[(at: Instant, action: Action)]):
  for wrong <- CommandPlan.mistake(actions.map(_.at)) do
    throw IllegalArgumentException(s"a command's plan: $wrong")

object CommandPlan:
  /** Most actions of one plan, which fit into one packet of TCP. */
  final val Most = 16

  /** Time for which a plan's last action acts. */
  val Hold: Span = Span.ofSeconds(1)

  /** A plan that only asks whether plans are accepted. */
  val Question: CommandPlan = CommandPlan(0, Vector.empty)

  /** Why actions of these moments are not a plan's, if they are not. */
  def mistake(moments: Seq[Instant]): Option[String] =
    if moments.size > Most then Some(s"expected at most $Most actions, came ${moments.size}")
    else if moments.zip(moments.drop(1)).exists((one, next) => one >= next) then
      Some("expected moments in ascending order, came others")
    else None
