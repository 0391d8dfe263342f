package skein.forward

import java.util.concurrent.ConcurrentHashMap
import skein.formula.Untraceable
import skein.policy.{Policy, Assignment, PolicyFormula}
import skein.simd.Forms
import skein.units.Metres

/** Finds the policies that choose only horizontal velocities at the altitude of their vehicle's start:
  * forward simulation supports no others. [[skein.policy.Policy.isPlanar]] promises it; for others it is
  * checked in their formula.
  */
private object Level:
  private val known = ConcurrentHashMap[(Int, Assignment, Boolean), Forms[Policy, PolicyFormula]]()

  /** Why a policy may choose another action.
    *
    * @param self its place in a team
    */
  def refusal(policy: Policy, self: Int, assignment: Assignment, startDownM: Double): Option[String] =
    if policy.isPlanar then None
    else
      Seq(false, true).iterator
        .flatMap: isPredicted =>
          formula(policy, self, assignment, isPredicted).fold(
            why => Some(s"it is not seen that its policy keeps the altitude of its start: ${why.getMessage}"),
            _.leaves(policy, Metres(startDownM))
          )
        .nextOption()

  /** The formula of a policy, traced once for each form.
    *
    * @param self its place in a team
    */
  def formula(
      policy: Policy,
      self: Int,
      assignment: Assignment,
      isPredicted: Boolean
  ): Either[Untraceable, PolicyFormula] =
    val forms = known.computeIfAbsent(
      (self, assignment, isPredicted),
      _ =>
        Forms[Policy, PolicyFormula](_.fits(_, assignment)):
          PolicyFormula.of(_, self, assignment, isPredicted)
    )
    forms(policy)
