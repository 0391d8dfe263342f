package skein.forward

import skein.formula.Untraceable
import skein.policy.{Policy, Assignment, PolicyFormula}
import skein.simd.{Forms, Recent}
import skein.units.Metres

/** Checks that policies choose only horizontal velocities at the altitude of their vehicle's start, as level
  * simulation requires. [[skein.policy.Policy.isPlanar]] promises it; other policies are checked by their
  * formula.
  */
private object Level:
  private val known = Recent[(Int, Assignment, Boolean), Forms[Policy, PolicyFormula]](most = 512)

  /** The reason why a policy may choose another action; None if it never does.
    *
    * @param self the vehicle's index in the team
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

  /** The formula of a policy; each form is traced only once.
    *
    * @param self the vehicle's index in the team
    */
  def formula(
      policy: Policy,
      self: Int,
      assignment: Assignment,
      isPredicted: Boolean
  ): Either[Untraceable, PolicyFormula] =
    val forms = known.getOrMake((self, assignment, isPredicted)):
      Forms[Policy, PolicyFormula](_.fits(_, assignment)):
        PolicyFormula.of(_, self, assignment, isPredicted)
    forms(policy)
