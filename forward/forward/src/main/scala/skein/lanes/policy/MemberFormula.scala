package skein.lanes.policy

import skein.formula.{Formula, Node, Trace, Untraceable}
import skein.policy.{Policy, Assignment, PolicyFormula, PolicyInput, TeamObservation, TeamPolicy}
import skein.policy.PolicyFormula.Motion

/** How one vehicle of a team decides, as a formula. */
private[lanes] trait MemberFormula:
  def trace: Trace

  /** What an input of the formula is. */
  def input(index: Int): PolicyInput

  def motion: Motion

  /** What is remembered. */
  def memory: Vector[Node]

  /** Whether it may ask its vehicle to turn. */
  def turns: Boolean

  def fits(policy: Policy): Boolean

  /** The parameters of a policy that [[fits]]. */
  def parametersOf(policy: Policy): Array[Double]

  /** What it remembers before its first decision. */
  def startOf(policy: Policy): Array[Double]

  /** Why a policy does not keep the altitude of its vehicle's start. */
  def leaves(policy: Policy, startDownM: Double): Option[String]

private[lanes] object MemberFormula:
  /** What a policy computes at its place in a team.
    *
    * @param isPredicted whether readings are carried forward
    */
  def of(
      policy: Policy,
      self: Int,
      assignment: Assignment,
      isPredicted: Boolean
  ): Either[Untraceable, MemberFormula] =
    val count = assignment.rivals.size
    policy match
      case team: TeamPolicy => courseOf(team, self, count).map(OfCourse(_, self, count))
      case _ => PolicyFormula.of(policy, self, assignment, isPredicted).map(OfChoice(_, assignment))

  private def courseOf(policy: TeamPolicy, self: Int, count: Int): Either[Untraceable, Formula] = Formula.of(
    policy,
    "course",
    Seq("northM", "eastM", "northMps", "eastMps").map(field => s"seen.$field" -> count).toMap,
    Some(Seq(classOf[TeamObservation])),
    Map("seen.self" -> self)
  )

  /** Of [[TeamPolicy.course]]. */
  private final class OfCourse(formula: Formula, self: Int, count: Int) extends MemberFormula:
    def trace: Trace                   = formula.trace
    def input(index: Int): PolicyInput =
      if index < 2 * count then PolicyInput.Position(index % count, index / count)
      else if index < 4 * count then PolicyInput.Velocity(index % count, index / count - 2)
      else if index == 4 * count then PolicyInput.Heading(self)
      else PolicyInput.Elapsed
    val motion: Motion =
      val Vector((_, headingRad), (_, speedMps)) = formula.outputs: @unchecked
      Motion.Along(headingRad, speedMps)
    def memory: Vector[Node]                                            = Vector.empty
    def turns: Boolean                                                  = false
    def fits(policy: Policy): Boolean                              = formula.fits(policy)
    def parametersOf(policy: Policy): Array[Double]                = formula.parametersOf(policy)
    def startOf(policy: Policy): Array[Double]                     = Array.emptyDoubleArray
    def leaves(policy: Policy, startDownM: Double): Option[String] = None

  /** Of [[Policy.choose]]. */
  private final class OfChoice(of: PolicyFormula, assignment: Assignment) extends MemberFormula:
    export of.{inputs as _, leaves as _, fits as _, formula as _, *}
    def trace: Trace                                                    = of.formula.trace
    def input(index: Int): PolicyInput                                  = of.inputs(index)
    def fits(policy: Policy): Boolean                              = of.fits(policy, assignment)
    def leaves(policy: Policy, startDownM: Double): Option[String] =
      of.leaves(policy, skein.units.Metres(startDownM))
