package skein.loop

import skein.policy.{Agent, Policy, HoldPosition, KeepHeading, PolicyFamily}
import skein.scenario.Scenarios
import skein.units.Span

/** By when a policy must have decided, and what is done where it has not. The policy then runs beside the
  * loop, on threads of its own, and what it decides too late is not used.
  */
final case class Deadline(within: Span, otherwise: Fallback):
  require(within > Span.Zero, "a deadline must be positive")

/** What is done instead of a decision that came too late. */
enum Fallback:
  /** Nothing is sent: the vehicle flies on under its last move, for as long as that lasts. */
  case Hold

  /** The last decision, once more. */
  case Repeat

  /** The vehicle is told to stay where it is. */
  case Hover

  /** A policy of the family, where it is meant for the vehicle's role; for others as [[Repeat]]. */
  case Decides(family: PolicyFamily)

  def label: String = this match
    case Hold            => "hold"
    case Repeat          => "repeat"
    case Hover           => "hover"
    case Decides(family) => family.name

  /** Who decides for an agent; absent where nobody does. */
  def policy(agent: Agent): Option[Policy] = this match
    case Hold                                                 => None
    case Hover                                                => Some(HoldPosition)
    case Decides(family) if family.roles.contains(agent.role) => Some(family.defaultPolicy)
    case _                                                    => Some(KeepHeading)

object Fallback:

  /** `hold`, `repeat`, `hover` or a family's name. */
  def parse(text: String)(using scenarios: Scenarios): Either[String, Fallback] = text match
    case "hold"   => Right(Hold)
    case "repeat" => Right(Repeat)
    case "hover"  => Right(Hover)
    case name     =>
      scenarios.family(name).map(Decides(_)).left.map(reason =>
        s"expected hold, repeat, hover or a policy: $reason"
      )
