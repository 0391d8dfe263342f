package skein.policy

/** Policies of one form that differ in named parameters: what a search chooses from, and what a policy file names.
  *
  * @param name
  *   as on the command line and in policy files, for example `paper-pursuer`
  * @param summary
  *   one line for people
  * @param roles
  *   for whom its policies are meant
  * @param space
  *   the parameters, their bounds and defaults
  * @param make
  *   a policy of one value per axis; a pure function
  */
final class PolicyFamily(
    val name: String,
    val summary: String,
    val roles: Set[Role],
    val space: SearchSpace,
    make: Vector[Double] => Policy
):

  /** @param parameters
    *   one per axis of [[space]], in its order; they may lie outside the bounds, which only limit a search
    */
  def policy(parameters: Vector[Double]): Policy =
    require(
      parameters.size == space.dimension,
      s"family $name has ${space.dimension} parameters, got ${parameters.size}"
    )
    make(parameters)

  def defaultPolicy: Policy = policy(space.defaults)

  override def toString: String = name

object PolicyFamily:

  val paperPursuer: PolicyFamily = PolicyFamily(
    "paper-pursuer",
    "turns towards the evader's side at a constant rate",
    Set(Role.Pursuer),
    SearchSpace(Vector(Axis("turnRateRadPerS", 0.2, 3.0, 1.0))),
    parameters => PaperPursuer(parameters(0))
  )

  val paperEvader: PolicyFamily = PolicyFamily(
    "paper-evader",
    "runs, breaks away near the pursuer, hides inside its turning circles",
    Set(Role.Evader),
    SearchSpace(Vector(Axis("turningRadiusM", 1.0, 24.0, 8.0))),
    parameters => PaperEvader(parameters(0))
  )

  /** All that have a fixed number of parameters, in the order in which they are listed to people. */
  val all: Vector[PolicyFamily] = Vector(paperPursuer, paperEvader)

  /** The family of this name.
    *
    * @return
    *   or what was expected
    */
  def parse(text: String): Either[String, PolicyFamily] =
    all
      .find(_.name == text)
      .toRight(s"expected a family of policies (${all.map(_.name).mkString(", ")}), came '$text'")
