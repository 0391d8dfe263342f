package skein.policy

import skein.units.OwnFailure

/** Policies of one form that differ in named parameters: searches choose from them, and policy files name
  * them.
  *
  * @param name its name on the command line and in policy files, for example `paper-pursuer`
  * @param summary one line for users
  * @param roles the roles for which its policies are meant
  * @param space the parameters, their bounds and defaults
  * @param make creates a policy from one value per axis; a pure function
  */
final class PolicyFamily(
    val name: String,
    val summary: String,
    val roles: Set[Role],
    val space: SearchSpace,
    make: Vector[Double] => Policy
):

  /** The policy with these parameters.
    *
    * @param parameters one per axis of [[space]], in its order; they may lie outside the bounds, which only
    *   limit a search
    * @throws OwnFailure if the family throws
    */
  def policy(parameters: Vector[Double]): Policy =
    require(
      parameters.size == space.dimension,
      s"family $name has ${space.dimension} parameters, got ${parameters.size}"
    )
    OwnFailure.told(s"the family $name")(make(parameters))

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

  /** The paper's policy family for a role of the duel, as a baseline for results. */
  def paperOf(role: Role): PolicyFamily = if role == Role.Pursuer then paperPursuer else paperEvader

  private val turnRate = Axis("turnRateRadPerS", 0.2, 3.0, 1.0)

  val purePursuit: PolicyFamily = PolicyFamily(
    "pure-pursuit",
    "heads for where the opponent is",
    Set(Role.Pursuer),
    SearchSpace(Vector(turnRate)),
    parameters => PurePursuit(parameters(0))
  )

  val proportionalNavigation: PolicyFamily = PolicyFamily(
    "proportional-navigation",
    "turns a multiple as fast as the line of sight",
    Set(Role.Pursuer),
    SearchSpace(Vector(Axis("gain", 1.0, 8.0, 3.0), turnRate)),
    parameters => ProportionalNavigation(parameters(0), parameters(1))
  )

  val leadPursuit: PolicyFamily = PolicyFamily(
    "lead-pursuit",
    "heads for where it would meet the opponent",
    Set(Role.Pursuer),
    SearchSpace(Vector(Axis("speedRatio", 0.05, 0.95, 0.5), Axis("lead", 0.0, 2.0, 1.0), turnRate)),
    parameters => LeadPursuit(parameters(0), parameters(1), parameters(2))
  )

  val chauffeurPursuer: PolicyFamily = PolicyFamily(
    "chauffeur-pursuer",
    "turns hard towards the opponent and dashes; flies off first where it would slip by",
    Set(Role.Pursuer),
    SearchSpace(
      Vector(
        Axis("turningRadiusM", 1.0, 24.0, 8.0),
        Axis("speedRatio", 0.05, 0.95, 0.5),
        Axis("captureRadiusM", 0.0, 12.0, 1.5),
        Axis("turnRateRadPerS", 0.2, 3.0, 1.25)
      )
    ),
    parameters => ChauffeurPursuer(parameters(0), parameters(1), parameters(2), parameters(3))
  )

  val chauffeurEvader: PolicyFamily = PolicyFamily(
    "chauffeur-evader",
    "runs along the line on which the chase will end; dodges near the pursuer",
    Set(Role.Evader),
    SearchSpace(
      Vector(
        Axis("turningRadiusM", 1.0, 24.0, 8.0),
        Axis("speedRatio", 0.05, 0.95, 0.5),
        Axis("dodgeM", 0.0, 30.0, 4.0)
      )
    ),
    parameters => ChauffeurEvader(parameters(0), parameters(1), parameters(2))
  )

  /** Networks of one shape, named `neural:8x8` by their hidden layers; the default's weights are all zero:
    * straight on.
    */
  def neural(shape: NeuralShape): PolicyFamily = PolicyFamily(
    s"$NeuralPrefix${shape.hidden.mkString("x")}",
    s"a neural network with hidden layers of $shape",
    Set(Role.Pursuer, Role.Evader),
    SearchSpace(shape.names.map(Axis(_, -3.0, 3.0)) :+ turnRate),
    parameters => NeuralPolicy(shape, parameters.init, parameters.last)
  )

  /** Networks as `./skein learn` trains them, named like `learned:64x64`, or `climbing:64x64` if they climb
    * ([[LearnedPolicy.label]]); the default's weights are all zero.
    */
  def learned(shape: NeuralShape): PolicyFamily =
    val climbs = LearnerSpace.of(shape).climbs
    PolicyFamily(
      s"${if climbs then ClimbingPrefix else LearnedPrefix}${LearnedPolicy.label(shape)}",
      s"a neural network of all that a learner sees, with hidden layers of $shape",
      Set(Role.Pursuer, Role.Evader),
      SearchSpace(shape.names.map(Axis(_, -3.0, 3.0)) ++ most(climbs)),
      parameters =>
        val (weights, most) = parameters.splitAt(shape.parameters)
        LearnedPolicy(shape, weights, most(0), most(1), most.lift(2).getOrElse(0))
    )

  /** The axes of what the largest shares of a learner's action stand for. */
  private[skein] def most(climbs: Boolean): Vector[Axis] =
    Vector(turnRate, Axis("turnRad", 0.0, math.Pi, 0.0)) ++
      Option.when(climbs)(Axis("climbMps", 0.0, 10.0, LearnerSpace.ClimbMps))

  private val NeuralPrefix   = "neural:"
  private val LearnedPrefix  = "learned:"
  private val ClimbingPrefix = "climbing:"

  /** Why a family's name conflicts with those of other families, if it does. */
  def mistake(own: Vector[PolicyFamily]): Option[String] =
    val names = (all ++ own).map(_.name)
    names
      .diff(names.distinct)
      .headOption
      .map(twice => s"every family of policies needs a name of its own, got '$twice' twice")
      .orElse(own.map(_.name).find(name => !name.matches("[a-z][a-z0-9-]*")).map(came =>
        s"expected small letters, digits and dashes as a family's name, got '$came'"
      ))

  /** All families with a fixed number of parameters, in the order of listings. */
  val all: Vector[PolicyFamily] =
    Vector(
      paperPursuer,
      purePursuit,
      proportionalNavigation,
      leadPursuit,
      chauffeurPursuer,
      paperEvader,
      chauffeurEvader
    )

  /** The family of this name, one of Skein's or of the program's own families.
    *
    * @param own further families that the program knows
    * @return Left says which names were expected
    */
  def parse(text: String, own: Vector[PolicyFamily] = Vector.empty): Either[String, PolicyFamily] =
    def known = all ++ own
    if text.startsWith(NeuralPrefix) then NeuralShape.parse(text.stripPrefix(NeuralPrefix)).map(neural)
    else if text.startsWith(LearnedPrefix) then
      LearnedPolicy.parse(text.stripPrefix(LearnedPrefix), LearnerSpace.Level).map(learned)
    else if text.startsWith(ClimbingPrefix) then
      LearnedPolicy.parse(text.stripPrefix(ClimbingPrefix), LearnerSpace.Climbing).map(learned)
    else
      known
        .find(_.name == text)
        .toRight(
          s"expected a family of policies (${known.map(_.name).mkString(", ")}, " +
            s"${NeuralPrefix}8x8, ${LearnedPrefix}64x64, or ${ClimbingPrefix}64x64), got '$text'"
        )
