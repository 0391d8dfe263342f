package skein.formula

/** Conditions known on the branch that is being traced. Mutable, for one thread. */
private[formula] final class Assumptions:
  private var known = Map.empty[Node, Boolean]

  /** Whether a condition holds; None if unknown. */
  def apply(condition: Node): Option[Boolean] = condition.op match
    case Op.Always => Some(true)
    case Op.Not    => apply(condition.args(0)).map(!_)
    case _         => known.get(condition)

  /** Traces a branch under the assumption that a condition holds, or that it does not. */
  def under[A](condition: Node, holds: Boolean)(way: => A): A =
    val before = known
    assume(condition, holds)
    try way
    finally known = before

  private def assume(condition: Node, holds: Boolean): Unit =
    if condition.op == Op.Not then assume(condition.args(0), !holds)
    else if !known.contains(condition) then
      known += condition -> holds
      // What is known of both conditions may determine the other one now.
      for (both, each) <- known if both.op == Op.And || both.op == Op.Or do tellParts(both, each)

  private def tellParts(both: Node, holds: Boolean): Unit =
    val Vector(a, b) = both.args
    // If `and` holds, both parts hold; if `or` does not, neither does.
    if (both.op == Op.And) == holds then for part <- both.args do assume(part, holds)
    else
      for (one, other) <- Seq((a, b), (b, a)) if apply(one).contains(!holds) do assume(other, holds)
