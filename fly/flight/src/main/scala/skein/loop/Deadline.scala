package skein.loop

import skein.policy.{Agent, Policy, HoldPosition, KeepHeading, PolicyFamily}
import skein.scenario.Scenarios
import skein.units.Span

/** The time-out of a policy's decision, and the fallback. The policy then runs concurrently with the loop, on
  * its own threads, and late decisions are discarded.
  */
final case class Deadline(within: Span, otherwise: Fallback):
  require(within > Span.Zero, "a deadline must be positive")

/** The replacement for a decision that is late. */
enum Fallback:
  /** Nothing is sent: the vehicle continues its last move until that ends. */
  case Hold

  case Repeat

  /** The vehicle is commanded to hold its position. */
  case Hover

  /** A policy of the family, if it is meant for the vehicle's role; for others like [[Repeat]]. */
  case Decides(family: PolicyFamily)

  def label: String = this match
    case Hold            => "hold"
    case Repeat          => "repeat"
    case Hover           => "hover"
    case Decides(family) => family.name

  /** The policy that decides for an agent; absent if none does. */
  def policy(agent: Agent): Option[Policy] = this match
    case Hold                                                 => None
    case Hover                                                => Some(HoldPosition)
    case Decides(family) if family.roles.contains(agent.role) => Some(family.defaultPolicy)
    case _                                                    => Some(KeepHeading)

object Fallback:

  /** Reads `hold`, `repeat`, `hover` or a family's name. */
  def parse(text: String)(using scenarios: Scenarios): Either[String, Fallback] = text match
    case "hold"   => Right(Hold)
    case "repeat" => Right(Repeat)
    case "hover"  => Right(Hover)
    case name     =>
      scenarios.family(name).map(Decides(_)).left.map(reason =>
        s"expected hold, repeat, hover or a policy: $reason"
      )
