package skein.settings

import com.typesafe.config.{Config, ConfigFactory, ConfigValueFactory}
import java.nio.file.Path
import pureconfig.*
import pureconfig.error.CannotConvert
import scala.util.Try
import skein.loop.*
import skein.loop.learning.{Learning, LearningPolicy, Lessons, LearnerUpdate}
import skein.policy.{Agent, Fleet, LearnedPolicy}
import skein.port.Moves
import skein.record.ImagingSensor
import skein.scenario.{Equipment, Kept, PaperDuel, Scenario, Scenarios}
import skein.scene.SceneFile
import skein.signal.LatencyProfile
import skein.units.*
import skein.vehicle.{SensorNoise, VehicleKind}

/** The flights of an experiment: every loop over every link, and `paused`, the ground truth, once without a
  * network. The configuration has a key for each field, and a recording a parameter, in this order
  * ([[RecordedSetting]]).
  *
  * @param scene the built-in simulator's world; by default the scenario's
  * @param predictor the model by which `predictive` predicts multirotors; cars are predicted by their own
  *   model
  * @param movesInFlight maximum number of unanswered moves of one vehicle; more than 2 are for links that
  *   never deliver several simultaneously: see [[skein.flow.Steer]]
  * @param planInPacket whether `predictive` sends plans to a buffer on the vehicle's side of the link: see
  *   [[LoopSettings]]
  * @param knows what the controller of a vehicle knows of the others, in all loops
  * @param strangers how `predictive` predicts vehicles whose commands it does not know
  * @param decentralised whether each vehicle has a controller of its own, with a link of its own; then
  *   controllers know of the others what they read. `paused`, the ground truth, has a single controller,
  *   which knows positions too, and no link
  * @param only the vehicle that this process controls in a running simulator, while other processes control
  *   the rest
  * @param between with `decentralised`, the link over which controllers send one another what they read of
  *   their own vehicles; then they do not read the others
  * @param plant the built-in simulator's kind of multirotor
  * @param sensors errors of the vehicles' readings; without them readings are true
  * @param wire protocol of the simulator's connection
  * @param solver a remote solver for flights in addition to those that decide in this process; a decision
  *   then has a deadline, by default the period
  * @param images sources of recorded images and clouds
  * @param deadline deadline of every decision; without one, the loop waits for its policies
  * @param fallback the decision after a missed deadline
  * @param policies policies for flights of the scenario in addition to those with its own
  * @param onlyPolicies whether flights with the scenario's own policies are omitted
  */
final case class FlySettings(
    loops: List[AnyLoop],
    links: List[LatencyProfile],
    duration: Span,
    period: Span,
    seed: Long,
    scenario: Scenario = PaperDuel(),
    scene: Option[NamedScene] = None,
    planning: PlanSettings = PlanSettings(),
    predictor: PredictionModel = PredictionModel.Quadrotor,
    movesInFlight: Int = Moves.InFlight,
    planInPacket: Boolean = false,
    knows: Knowledge = Knowledge.All,
    strangers: Strangers = Strangers.Turn,
    decentralised: Boolean = false,
    only: Option[String] = None,
    between: Option[VehicleLink] = None,
    plant: SimulatedBody = SimulatedBody.AirSim,
    sensors: Option[SensorNoise] = None,
    wire: Wire = Wire.AirSim,
    solver: Option[SolverChoice] = None,
    images: List[ImageSource] = Nil,
    deadline: Option[Span] = None,
    fallback: Fallback = Fallback.Repeat,
    policies: List[PolicyFile] = Nil,
    onlyPolicies: Boolean = false
):

  /** The cameras and lidars from which the flight takes images and clouds. */
  def imagingSensors: Vector[ImagingSensor] = (seen ++ filmed.map((sensor, _) => sensor)).distinct

  /** The sensors whose images and clouds are recorded. */
  lazy val recordedImaging: Set[ImagingSensor] =
    (if images.contains(ImageSource.Seen) then seen.toSet else Set.empty) ++ filmed.map((sensor, _) => sensor)

  private def seen: Vector[ImagingSensor] =
    scenario.eyes.map(eye => ImagingSensor.camera(eye.vehicle, eye.camera, "Scene")) ++
      scenario.equipment.collect { case lidar: Equipment.Lidar =>
        ImagingSensor(lidar.vehicle, lidar.name, isLidar = true)
      }

  /** The cameras that are used for the recording alone, with their periods. */
  def filmed: Vector[(sensor: ImagingSensor, every: Span)] =
    for
      agent <- fleet.agents if commands(agent.name)
      case ImageSource.Camera(name, hz) <- images.toVector
    yield (ImagingSensor.camera(agent.name, name, "Scene"), Span.ofSeconds(1 / hz))

  /** The scene of the built-in simulator. */
  def world: NamedScene = scene.orElse(NamedScene.shipped(scenario.scene)).getOrElse(NamedScene.Empty)

  def fleet: Fleet = scenario.fleet

  def loopSettings(plan: FlightPlan): LoopSettings =
    val all =
      loopSettings.copy(seed = plan.seed, planInPacket = planInPacket && plan.loop == LoopKind.Predictive)
    if plan.solver.isEmpty then all else all.copy(deadline = Some(Deadline(deadlineOf(plan).get, fallback)))

  /** Whether each vehicle has a controller of its own in a flight. */
  def isDecentralised(plan: FlightPlan): Boolean = decentralised && plan.loop != LoopKind.Paused

  /** Whether this process flies the vehicle of this name. */
  def commands(vehicle: String): Boolean = only.forall(_ == vehicle)

  /** The vehicles that this process flies, by their indices in the scenario. */
  def own: Vector[Int] =
    fleet.agents.indices.toVector.filter(self => commands(fleet.agents(self).name))

  /** The deadline of a flight's decisions, if there is one. */
  def deadlineOf(plan: FlightPlan): Option[Span] =
    if plan.solver.isEmpty then deadline else deadline.orElse(Some(period))

  /** The settings of the loops. Plans keep the scenario's limits. */
  def loopSettings: LoopSettings =
    val agents = fleet.agents
    val timely = LoopSettings
      .every(period)
      .copy(
        model = vehicle => predictor.forAgent(agents(vehicle)),
        planning = planning.keeping(scenario),
        movesInFlight = movesInFlight,
        knows = if decentralised then Knowledge.Positions else knows,
        strangers = strangers,
        deadline = deadline.map(Deadline(_, fallback))
      )
    if scenario.isAsPublished then timely.asPublished else timely

  /** The flights, `paused` first, then those with policies of files. All have one seed, so that they differ
    * neither in gusts nor in errors of readings.
    */
  def plans: Vector[FlightPlan] =
    val names  = FlySettings.numbered(policies.map(_.name))
    val chosen = policies.zip(names).map((policy, name) => ChosenPolicy(name, policy))
    withSolver((if onlyPolicies then Vector.empty else papers) ++ chosen.flatMap(plansWith))

  /** Adds flights with the solver, whose seeds equal those without. */
  private def withSolver(plans: Vector[FlightPlan]): Vector[FlightPlan] =
    plans ++ solver.toVector.flatMap: choice =>
      plans
        .filter(plan => FlySettings.decidedElsewhere(plan.loop))
        .map(plan => plan.copy(id = s"${plan.id}-solver", solver = Some(choice)))

  /** The flights with a policy instead of the scenario's. */
  def plansWith(policy: ChosenPolicy): Vector[FlightPlan] =
    papers.map(plan => plan.copy(id = s"${plan.id}-${policy.name}", policy = Some(policy)))

  private def papers: Vector[FlightPlan] =
    val truth  = Option.when(loops.contains(LoopKind.Paused))((LoopKind.Paused, LatencyProfile.none))
    val others =
      for
        link <- links
        loop <- loops if loop != LoopKind.Paused
      yield (loop, link)
    (truth.toVector ++ others).distinct.map: (loop, link) =>
      val plan = FlightPlan(s"${loop.label}-${link.name}", loop, link, seed)
      if isDecentralised(plan) then plan.copy(id = s"${plan.id}-decentralised") else plan

/** A policy that replaces the scenario's.
  *
  * @param name short name for tables; unique within an experiment
  * @param learning if it learns during the flight; then the file is its initial network
  */
final case class ChosenPolicy(name: String, file: PolicyFile, learning: Option[Learning] = None):

  /** The scenario with this policy for all agents of its role, which learns by lessons.
    *
    * @param note called with each update, the vehicle and the number of its next decision
    */
  def learningIn(fleet: Fleet, lessons: Lessons, explore: Double, seed: Long, period: Span)(
      note: (String, Long, LearnerUpdate) => Unit
  ): Fleet =
    def version(parameters: Vector[Double]) = file.family.policy(parameters).asInstanceOf[LearnedPolicy]
    Fleet(fleet.agents.map: agent =>
      if agent.role != file.role then agent
      else
        agent.copy(policy =
          LearningPolicy(
            version(file.parameters),
            version,
            explore,
            seed,
            lessons,
            period,
            note(agent.name, _, _)
          )
        ))

/** One flight of an experiment.
  *
  * @param policy the policy; by default the scenario's
  * @param solver the solver that decides; by default this process
  */
final case class FlightPlan(
    id: String,
    loop: AnyLoop,
    link: LatencyProfile,
    seed: Long,
    policy: Option[ChosenPolicy] = None,
    solver: Option[SolverChoice] = None
):
  /** The agents of the flight, in the settings' scenario. */
  def fleet(settings: FlySettings): Fleet =
    policy.fold(settings.fleet)(_.file.flownIn(settings.fleet))

  def file(folder: Path): Path = folder.resolve(FlightPlan.fileName(id))

  /** This flight in virtual time, in addition to the live one: `count` times, first with an equal seed, then
    * with the following ones.
    */
  def twins(count: Int): Vector[FlightPlan] =
    Vector.tabulate(count): index =>
      copy(id = s"$id-virtual${if index == 0 then "" else s"-${index + 1}"}", seed = seed + index)

object FlightPlan:
  def fileName(id: String): String = id.replaceAll("[^A-Za-z0-9.-]", "_") + ".duckdb"

object FlySettings:
  /** Maximum altitude, m: forward simulation and the built-in simulator use the air density at the ground.
    */
  val MostAltitudeM = 1000.0

  /** Maximum number of controllers of one flight: each opens five connections, and the built-in simulator
    * takes 256.
    */
  val MostControllers = 50

  /** Names that differ: where one stands again, a number follows. */
  private[skein] def numbered(names: Seq[String]): Vector[String] =
    names.toVector.zipWithIndex.map: (name, index) =>
      val before = names.take(index).count(_ == name)
      if before == 0 then name else s"$name-${before + 1}"

  /** Reads `skein.fly`.
    *
    * @return Left lists every mistake, with its file, line, and what was expected
    */
  def read(config: Config)(using Scenarios): Either[String, FlySettings] =
    for
      _        <- ConfigMistakes.ofShape(config, "skein.fly").toLeft(())
      scenario <- ScenarioSettings.read(config)
      timed =
        if config.hasPath(Duration) then config
        else config.withValue(Duration, ConfigValueFactory.fromAnyRef(s"${scenario.duration.toSeconds}s"))
      settings <-
        given ConfigReader[Scenario]    = ConfigReader.fromFunction(_ => Right(scenario))
        given ConfigReader[FlySettings] = ConfigKeys.reader
        ConfigSource.fromConfig(timed).at("skein.fly").load[FlySettings].left.map(ConfigMistakes.of(_, timed))
      mistakes = FlightMistakes(settings, timed).all
      _ <- Expect.that(mistakes.isEmpty)(mistakes.mkString("\n"))
    yield settings

  private val Duration = "skein.fly.duration"

  /** Whether a solver can decide for a loop: `paused` waits with its simulator stopped. */
  def decidedElsewhere(loop: AnyLoop): Boolean = loop != LoopKind.Paused

  private given ConfigReader[Int]    = whole(_.intValueExact)
  private given ConfigReader[Long]   = whole(_.longValueExact)
  private given ConfigReader[Double] = parsed: text =>
    text.toDoubleOption.filter(_.isFinite).toRight(s"expected a finite number, got '$text'")

  /** Reads a number exactly, so that `1e3` is a whole number too. */
  private def whole[A](number: java.math.BigDecimal => A): ConfigReader[A] = parsed: text =>
    Try(number(java.math.BigDecimal(text))).toOption.toRight(s"expected a whole number, got '$text'")

  private given ConfigReader[Span] = parsed(Span.parse)

  private given (using Scenarios): ConfigReader[PredictionModel] = parsed(PredictionModel.parse)

  private given ConfigReader[NamedScene] = parsed(NamedScene.read)
  private given ConfigReader[Wire]       = parsed(Wire.parse)
  private given ConfigReader[Knowledge]  = parsed(Knowledge.parse)
  private given ConfigReader[Strangers]  = parsed(Strangers.parse)

  private given ConfigReader[SimulatedBody] = parsed(SimulatedBody.parse)
  private given ConfigReader[SensorNoise]   = parsed(SensorNoise.parse)

  private given ConfigReader[VehicleLink] = parsed(VehicleLink.parse)

  private given ConfigReader[SolverChoice] = parsed(SolverChoice.parse(_))
  private given ConfigReader[ImageSource]  = parsed(ImageSource.parse)

  private given (using Scenarios): ConfigReader[Fallback] = parsed(Fallback.parse)

  private given (using Scenarios): ConfigReader[PolicyFile] = parsed: text =>
    if text.startsWith("unix:") then OutsidePolicy.reach(text) else PolicyFile.read(text)

  private given ConfigReader[PlanSettings] =
    val standard = PlanSettings()
    // These are not configured: the scenario and the machine determine them.
    given ConfigReader[Vector[Kept]] = unread(standard.kept)
    val blocks = ConfigFactory.parseString(s"blocks-per-slice = ${standard.blocksPerSlice}").root
    ConfigKeys.reader[PlanSettings].contramapConfig(_.withFallback(blocks))

  private def unread[A](value: A): ConfigReader[A] = new ConfigReader[A] with ReadsMissingKeys:
    def from(cursor: ConfigCursor): ConfigReader.Result[A] = Right(value)

  private given (using Scenarios): ConfigReader[AnyLoop] = parsed(AnyLoop.parse)

  private given ConfigReader[LatencyProfile] = parsed(LinkText.profile)

  private def parsed[A](parse: String => Either[String, A]): ConfigReader[A] =
    ConfigReader[String].emap(text => parse(text).left.map(CannotConvert(text, "setting", _)))

/** What is wrong with settings of flights that were read from a configuration. */
private final class FlightMistakes(settings: FlySettings, config: Config):
  import FlightMistakes.*
  import settings.*

  private val (multirotors, cars) = fleet.agents.partition(_.kind == VehicleKind.Multirotor)
  private val isMavlink           = wire == Wire.Mavlink
  private val hasPaused           = loops.contains(LoopKind.Paused)

  /** Every mistake, with the place of its value. */
  def all: Seq[String] =
    val mistakes = Seq(
      first("loops", loops.isEmpty -> "expected at least one loop, got none"),
      first(
        "links",
        (links.isEmpty && loops.exists(_ != LoopKind.Paused)) ->
          "expected at least one link for any loop but paused, got none"
      ),
      tooShort,
      first("period", (period < Span.ofMillis(1)) -> s"expected 1 ms or more, got ${period.toMillis} ms"),
      first(s"${scenario.name}.agents", fleet.agents.isEmpty -> "expected one or more, got none"),
      first(
        s"${scenario.name}.scene",
        (scene.isEmpty && NamedScene.shipped(scenario.scene).isEmpty) ->
          s"expected ${SceneFile.Names.mkString(", ")}, got '${scenario.scene}'"
      ),
      multirotors.find(one => !isRightAltitude(altitudeM(one))).map(one =>
        s"${scenario.name}: expected starts above 0 and up to ${FlySettings.MostAltitudeM} m, " +
          s"got ${one.name} at ${altitudeM(one)} m"
      ),
      first(
        "wire",
        (isMavlink && hasPaused) ->
          "expected loops other than paused over MAVLink, since its vehicles' time does not pass in steps"
      ),
      cars.find(altitudeM(_) != 0).map(car =>
        s"${scenario.name}: expected cars on the ground, at 0 m, got ${car.name} at ${altitudeM(car)} m"
      ),
      cars.find(_ => isMavlink).map(car =>
        s"wire: expected multirotors alone over MAVLink, got the car ${car.name}"
      ),
      first(
        "images",
        (isMavlink && images.nonEmpty) -> "expected none with wire mavlink, which carries no images"
      ),
      first("only-policies", (onlyPolicies && policies.isEmpty) -> "expected policies beside it, got none"),
      Moves.mistake(movesInFlight).map("moves-in-flight: " + _),
      inPackets,
      ofKnowledge,
      ofStrangers,
      apart,
      ofOnly,
      ofBetween,
      first(
        "solver",
        (solver.isDefined && !loops.exists(FlySettings.decidedElsewhere)) ->
          "expected with a loop whose decisions can be made elsewhere, got with paused alone"
      ),
      first(
        "solver",
        (solver.isDefined && policies.exists(OutsidePolicy.decides)) ->
          "expected with policies that both processes have, got with one behind a socket"
      ),
      deadline.filter(_ <= Span.Zero).map(within =>
        s"deadline: expected more than 0, got ${within.toMillis} ms"
      ),
      late,
      idle,
      policies.find(!isFlown(_)).map(file =>
        s"policies: expected with a scenario of a ${PolicyFile.name(file.role)} and " +
          s"vehicles of another role, got with '${scenario.name}'"
      )
    ).flatten ++ planning.mistakes.map(mistake => ConfigKeys.ofMistake(s"planning.$mistake"))
    (if mistakes.isEmpty then ofPredictor.toSeq ++ ofPlans else mistakes).map(placed)

  /** A flight that is too short for its period, at the value that an option gave: the other value may be the
    * scenario's.
    */
  private def tooShort: Option[String] = Option.when(duration < period * 2):
    if isOption("period") && !isOption("duration") then
      s"period: expected half the duration (${(duration / 2).toMillis} ms) or less, got ${period.toMillis} ms"
    else s"duration: expected two periods (${(period * 2).toMillis} ms) or more, got ${duration.toMillis} ms"

  /** Replaces the key at the beginning of a mistake by the source of its value. */
  private def placed(mistake: String): String =
    val (key, said) = mistake.span(_ != ':')
    ConfigMistakes.oneLine(ConfigMistakes.at(s"skein.fly.$key", config) + said)

  /** Whether a key of `skein.fly` has its value from an option. */
  private def isOption(key: String): Boolean =
    val path = s"skein.fly.$key"
    config.hasPath(path) && ConfigKeys.optionOf(config.getValue(path).origin).isDefined

  /** A deadline that leaves no time for the answer after the search. */
  private def late: Option[String] =
    val searched = planning.deadline
    val within   = deadline.getOrElse(period)
    first(
      if deadline.isDefined then "deadline" else "period",
      (solver.isDefined && loops.contains(LoopKind.Plan) && within <= searched) ->
        (s"expected more than planning.deadline, for which a solver searches its plans, " +
          s"${searched.toMillis} ms; got ${within.toMillis} ms")
    )

  /** An option that no loop of the flights regards. */
  private def idle: Option[String] =
    def areOnly(idle: AnyLoop*) = loops.nonEmpty && loops.forall(idle.contains)
    val named                   = loops.map(_.label).mkString(", ")
    val isTimely                = deadline.isDefined || solver.isDefined
    first(
      "deadline",
      (deadline.isDefined && solver.isEmpty && areOnly(LoopKind.Paused, LoopKind.Plan)) ->
        s"expected with a loop in which policies decide by the clock, got with $named alone"
    )
      .orElse(first(
        "fallback",
        (isOption("fallback") && !isTimely) -> "expected with deadline or solver, got it alone"
      ))
      .orElse(first(
        "predictor",
        (isOption("predictor") && !loops.exists(loop => loop == LoopKind.Plan || predicts(loop))) ->
          s"expected with a loop that predicts, such as predictive, got with $named"
      ))
      .orElse(first(
        "images",
        (images.nonEmpty && areOnly(LoopKind.Paused)) ->
          "expected with a loop other than paused, which records none"
      ))

  private def inPackets: Option[String] = Option.when(planInPacket):
    first(
      "plan-in-packet",
      !loops.contains(LoopKind.Predictive) ->
        "expected with the loop predictive, which foresees its commands, got without it",
      isMavlink                                -> "expected vehicles over AirSim's protocol, got mavlink",
      (deadline.isDefined || solver.isDefined) ->
        "expected without deadline and solver, since the policy is asked for later moments too",
      policies.exists(OutsidePolicy.decides) ->
        "expected policies of this process, which are asked for later moments too, got one behind a socket",
      cars.nonEmpty ->
        s"expected multirotors, which hold plans, got the car ${cars.headOption.fold("")(_.name)}"
    )
  .flatten

  private def ofKnowledge: Option[String] = first(
    "knows",
    (knows != Knowledge.All && loops.contains(LoopKind.Plan)) ->
      "expected all with the loop plan, which plans against the policies of others, got positions",
    (knows != Knowledge.All && solver.isDefined) ->
      "expected all with a solver, which is told every command, got positions"
  )

  private def ofStrangers: Option[String] = Option.when(strangers != Strangers.Turn):
    first(
      "strangers",
      (loopSettings.knows == Knowledge.All) ->
        ("expected knows positions with it, or decentralised, since otherwise all commands are known, " +
          s"got ${strangers.label} without"),
      !loops.exists(predicts) ->
        s"expected a loop that predicts, such as predictive, got ${strangers.label} without",
      (strangers == Strangers.Belief && predictor == PredictionModel.ConstantVelocity) ->
        "expected turn or straight with the predictor constant-velocity, which predicts all straight on, got belief"
    )
  .flatten

  private def apart: Option[String] = Option.when(decentralised):
    val joint = loops.find(loop => loop == LoopKind.Plan || loop.isInstanceOf[OwnLoop])
    first(
      "decentralised",
      joint.isDefined ->
        s"expected loops that decide for each vehicle by itself ($Apart), got ${joint.fold("")(_.label)}",
      loops.forall(
        _ == LoopKind.Paused
      )                -> "expected a loop other than paused, which has a single controller",
      isMavlink        -> "expected vehicles over AirSim's protocol, got mavlink",
      solver.isDefined -> "expected no solver, which decides for all",
      (isOption("knows") && knows == Knowledge.All) ->
        "expected knows positions, since no message carries the commands of others, got all",
      (fleet.agents.sizeIs > FlySettings.MostControllers) ->
        s"expected at most ${FlySettings.MostControllers} vehicles, got ${fleet.agents.size}"
    )
  .flatten

  private def ofOnly: Option[String] = settings.only.flatMap: name =>
    first(
      "only",
      !decentralised -> s"expected decentralised with it, got '$name' without",
      own.isEmpty    -> s"expected one of ${fleet.agents.map(_.name).mkString(", ")}, got '$name'",
      hasPaused      -> "expected loops other than paused, which stops the time of all vehicles"
    )

  private def ofBetween: Option[String] = between.flatMap: link =>
    first(
      "between",
      !decentralised -> s"expected decentralised with it, got '${link.text}' without",
      only.isDefined ->
        s"expected all controllers in this process, which carries their messages, got only ${only.getOrElse("")}"
    )

  /** Whether a policy can replace one in this fleet: its opponent is the nearest of another role. */
  private def isFlown(file: PolicyFile) =
    fleet.agents.map(_.role).distinct.sizeIs > 1 && fleet.agents.exists(_.role == file.role)

  private def ofPredictor: Option[String] = multirotors.iterator
    .flatMap(one => PredictionModel.mistake(predictor, altitudeM(one)))
    .nextOption()
    .map("predictor: " + _)

  private def ofPlans: Option[String] =
    val planned = plans.filter(_.loop == LoopKind.Plan).map(plan => plan -> plan.fleet(settings))
    val none    = planned.flatMap((_, fleet) => Planning.told(fleet).left.toOption).map("loops: " + _)
    val other   = planned.iterator
      .flatMap((plan, fleet) => JointPlanning.of(fleet, loopSettings(plan)).left.toOption)
      .map("predictor: " + _)
    none.headOption.orElse(other.nextOption())

private object FlightMistakes:
  private val Apart = "paused, sequential, futures, stream, predictive"

  /** The first mistake that is made, at a key. */
  private def first(key: String, mistakes: (Boolean, String)*): Option[String] =
    mistakes.collectFirst { case (true, what) => s"$key: $what" }

  private def altitudeM(agent: Agent) = -agent.startPositionNed.z

  private def isRightAltitude(altitudeM: Double) = altitudeM > 0 && altitudeM <= FlySettings.MostAltitudeM

  private def predicts(loop: AnyLoop) = loop == LoopKind.Predictive || loop.isInstanceOf[OwnLoop]
