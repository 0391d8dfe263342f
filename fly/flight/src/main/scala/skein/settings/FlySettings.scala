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

  private def multirotors: Vector[Agent] = fleet.agents.filter(_.kind == VehicleKind.Multirotor)
  private def cars: Vector[Agent]        = fleet.agents.filter(_.kind == VehicleKind.Car)

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

  private val Apart = "paused, sequential, futures, stream, predictive"

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
      valid <- validated(settings, timed)
    yield valid

  private val Duration = "skein.fly.duration"

  private def validated(settings: FlySettings, config: Config): Either[String, FlySettings] =
    val mistakes = Seq(
      Option.when(settings.loops.isEmpty)("loops: expected at least one loop, got none"),
      Option.when(settings.links.isEmpty && settings.loops.exists(_ != LoopKind.Paused))(
        "links: expected at least one link for any loop but paused, got none"
      ),
      Option.when(settings.duration < settings.period * 2)(shortMistake(settings, config)),
      Option.when(
        settings.period < Span.ofMillis(1)
      )(s"period: expected 1 ms or more, got ${settings.period.toMillis} ms"),
      Option.when(settings.fleet.agents.isEmpty)(
        s"${settings.scenario.name}.agents: expected one or more, got none"
      ),
      Option.when(settings.scene.isEmpty && NamedScene.shipped(settings.scenario.scene).isEmpty)(
        s"${settings.scenario.name}.scene: expected ${SceneFile.Names.mkString(", ")}, " +
          s"got '${settings.scenario.scene}'"
      ),
      settings.multirotors.find(agent => !isRightAltitude(-agent.startPositionNed.z)).map(agent =>
        s"${settings.scenario.name}: expected starts above 0 and up to " +
          s"$MostAltitudeM m, got ${agent.name} at ${-agent.startPositionNed.z} m"
      ),
      Option.when(settings.wire == Wire.Mavlink && settings.loops.contains(LoopKind.Paused))(
        "wire: expected loops other than paused over MAVLink, since " +
          "its vehicles' time does not pass in steps"
      ),
      settings.cars
        .find(_.startPositionNed.z != 0)
        .map(car =>
          s"${settings.scenario.name}: expected cars on the ground, at 0 " +
            s"m, got ${car.name} at ${-car.startPositionNed.z} m"
        ),
      settings.cars.find(_ => settings.wire == Wire.Mavlink).map(car =>
        s"wire: expected multirotors alone over MAVLink, got the car ${car.name}"
      ),
      Option.when(settings.wire == Wire.Mavlink && settings.images.nonEmpty)(
        "images: expected none with wire mavlink, which carries no images"
      ),
      Option.when(settings.onlyPolicies && settings.policies.isEmpty)(
        "only-policies: expected policies beside it, got none"
      ),
      Moves.mistake(settings.movesInFlight).map("moves-in-flight: " + _),
      packetMistake(settings).map("plan-in-packet: " + _),
      knowsMistake(settings).map("knows: " + _),
      strangersMistake(settings).map("strangers: " + _),
      apartMistake(settings, isGiven = optionAt("knows", config).isDefined).map("decentralised: " + _),
      onlyMistake(settings).map("only: " + _),
      betweenMistake(settings).map("between: " + _),
      Option.when(settings.solver.isDefined && !settings.loops.exists(decidedElsewhere))(
        "solver: expected with a loop whose decisions can be made elsewhere, got with paused alone"
      ),
      Option.when(settings.solver.isDefined && settings.policies.exists(OutsidePolicy.decides))(
        "solver: expected with policies that both processes have, got with one behind a socket"
      ),
      Option.when(settings.deadline.exists(_ <= Span.Zero))(
        s"deadline: expected more than 0, got ${settings.deadline.fold(0.0)(_.toMillis)} ms"
      ),
      lateMistake(settings),
      idleMistake(settings, config),
      settings.policies.find(file => !isFlownIn(settings.fleet, file)).map(file =>
        s"policies: expected with a scenario of a ${PolicyFile.name(file.role)} and " +
          s"vehicles of another role, got with '${settings.scenario.name}'"
      )
    ).flatten ++ settings.planning.mistakes.map(mistake => ConfigKeys.ofMistake(s"planning.$mistake"))
    val all = if mistakes.isEmpty then predictorMistake(settings).toSeq ++ planMistake(settings) else mistakes
    Either.cond(all.isEmpty, settings, all.map(placed(_, config)).mkString("\n"))

  /** The mistake of a flight that is too short for its period, at the value that an option gave: the other
    * value may be the scenario's.
    */
  private def shortMistake(settings: FlySettings, config: Config): String =
    if optionAt("period", config).isDefined && optionAt("duration", config).isEmpty then
      s"period: expected half the duration (${(settings.duration / 2).toMillis} ms) or less, " +
        s"got ${settings.period.toMillis} ms"
    else
      s"duration: expected two periods (${(settings.period * 2).toMillis} ms) or more, " +
        s"got ${settings.duration.toMillis} ms"

  /** Replaces the key at the beginning of a mistake by the source of its value. */
  private def placed(mistake: String, config: Config): String =
    val (key, said) = mistake.span(_ != ':')
    ConfigMistakes.oneLine(ConfigMistakes.at(s"skein.fly.$key", config) + said)

  /** The option from which a key of `skein.fly` has its value, if any. */
  private def optionAt(key: String, config: Config): Option[String] =
    val path = s"skein.fly.$key"
    Option.when(config.hasPath(path))(config.getValue(path).origin).flatMap(ConfigKeys.optionOf)

  /** Whether a solver can decide for a loop: `paused` waits with its simulator stopped. */
  def decidedElsewhere(loop: AnyLoop): Boolean = loop != LoopKind.Paused

  /** The mistake of a deadline that leaves no time for the answer after the search. */
  private def lateMistake(settings: FlySettings): Option[String] =
    val searched = settings.planning.deadline
    val within   = settings.deadline.getOrElse(settings.period)
    Option.when(
      settings.solver.isDefined && settings.loops.contains(LoopKind.Plan) && within <= searched
    ):
      val which = if settings.deadline.isDefined then "deadline" else "period"
      s"$which: expected more than planning.deadline, for which a solver searches " +
        s"its plans, ${searched.toMillis} ms; got ${within.toMillis} ms"

  /** The mistake of an option that no loop of the flights regards. */
  private def idleMistake(settings: FlySettings, config: Config): Option[String] =
    def isGiven(key: String) = optionAt(key, config).isDefined
    def only(idle: AnyLoop*) = settings.loops.nonEmpty && settings.loops.forall(idle.contains)
    val loops                = settings.loops.map(_.label).mkString(", ")
    val predicts             = settings.loops.exists(loop =>
      Seq(LoopKind.Predictive, LoopKind.Plan).contains(loop) || loop.isInstanceOf[OwnLoop]
    )
    if settings.deadline.isDefined && settings.solver.isEmpty && only(LoopKind.Paused, LoopKind.Plan) then
      Some(s"deadline: expected with a loop in which policies decide by the clock, got with $loops alone")
    else if isGiven("fallback") && settings.deadline.isEmpty && settings.solver.isEmpty then
      Some("fallback: expected with deadline or solver, got it alone")
    else if isGiven("predictor") && !predicts then
      Some(s"predictor: expected with a loop that predicts, such as predictive, got with $loops")
    else if settings.images.nonEmpty && only(LoopKind.Paused) then
      Some("images: expected with a loop other than paused, which records none")
    else None

  private def packetMistake(settings: FlySettings): Option[String] =
    if !settings.planInPacket then None
    else if !settings.loops.contains(LoopKind.Predictive) then
      Some("expected with the loop predictive, which foresees its commands, got without it")
    else if settings.wire == Wire.Mavlink then
      Some("expected vehicles over AirSim's protocol, got mavlink")
    else if settings.deadline.isDefined || settings.solver.isDefined then
      Some("expected without deadline and solver, since the policy is asked for later moments too")
    else if settings.policies.exists(OutsidePolicy.decides) then
      Some(
        "expected policies of this process, which are asked for later moments too, got one behind a socket"
      )
    else
      settings.cars.headOption.map(car => s"expected multirotors, which hold plans, got the car ${car.name}")

  private def knowsMistake(settings: FlySettings): Option[String] =
    val all = settings.knows == Knowledge.All
    if !all && settings.loops.contains(LoopKind.Plan) then
      Some("expected all with the loop plan, which plans against the policies of others, got positions")
    else if !all && settings.solver.isDefined then
      Some("expected all with a solver, which is told every command, got positions")
    else None

  private def strangersMistake(settings: FlySettings): Option[String] =
    import settings.strangers
    def predicts(loop: AnyLoop) = loop == LoopKind.Predictive || loop.isInstanceOf[OwnLoop]
    if strangers == Strangers.Turn then None
    else if settings.loopSettings.knows == Knowledge.All then
      Some(
        "expected knows positions with it, or decentralised, since otherwise all commands are known, " +
          s"got ${strangers.label} without"
      )
    else if !settings.loops.exists(predicts) then
      Some(s"expected a loop that predicts, such as predictive, got ${strangers.label} without")
    else
      Option.when(
        strangers == Strangers.Belief && settings.predictor == PredictionModel.ConstantVelocity
      )(
        "expected turn or straight with the predictor constant-velocity, which predicts all straight on, got belief"
      )

  private def apartMistake(settings: FlySettings, isGiven: Boolean): Option[String] =
    val other =
      settings.loops.collectFirst { case loop if loop == LoopKind.Plan || loop.isInstanceOf[OwnLoop] => loop }
    if !settings.decentralised then None
    else
      other
        .map(loop =>
          s"expected loops that decide for each vehicle by itself (${Apart}), got ${loop.label}"
        )
        .orElse(Option.when(
          settings.loops.forall(_ == LoopKind.Paused)
        )("expected a loop other than paused, which has a single controller"))
        .orElse(Option.when(
          settings.wire == Wire.Mavlink
        )("expected vehicles over AirSim's protocol, got mavlink"))
        .orElse(Option.when(settings.solver.isDefined)("expected no solver, which decides for all"))
        .orElse(Option.when(isGiven && settings.knows == Knowledge.All)(
          "expected knows positions, since no message carries the commands of others, got all"
        ))
        .orElse(Option.when(settings.fleet.agents.sizeIs > MostControllers)(
          s"expected at most ${MostControllers} vehicles, got ${settings.fleet.agents.size}"
        ))

  private def onlyMistake(settings: FlySettings): Option[String] =
    settings.only.flatMap: name =>
      if !settings.decentralised then Some(s"expected decentralised with it, got '$name' without")
      else if settings.own.isEmpty then
        Some(s"expected one of ${settings.fleet.agents.map(_.name).mkString(", ")}, got '$name'")
      else
        Option.when(settings.loops.contains(LoopKind.Paused)):
          "expected loops other than paused, which stops the time of all vehicles"

  private def betweenMistake(settings: FlySettings): Option[String] =
    settings.between.flatMap: link =>
      if !settings.decentralised then Some(s"expected decentralised with it, got '${link.text}' without")
      else
        settings.only.map: name =>
          s"expected all controllers in this process, which carries their messages, got only $name"

  private def isRightAltitude(altitudeM: Double) = altitudeM > 0 && altitudeM <= MostAltitudeM

  /** Whether a policy can replace one in this fleet: its opponent is the nearest of another role. */
  private def isFlownIn(fleet: Fleet, file: PolicyFile) =
    fleet.agents.map(_.role).distinct.sizeIs > 1 && fleet.agents.exists(_.role == file.role)

  private def predictorMistake(settings: FlySettings): Option[String] =
    settings.multirotors
      .flatMap(agent => PredictionModel.mistake(settings.predictor, -agent.startPositionNed.z))
      .headOption
      .map("predictor: " + _)

  private def planMistake(settings: FlySettings): Option[String] =
    val fleets = settings.plans.filter(_.loop == LoopKind.Plan).map(plan => plan -> plan.fleet(settings))
    fleets
      .flatMap((_, fleet) => Planning.told(fleet).left.toOption)
      .headOption
      .map("loops: " + _)
      .orElse:
        fleets
          .flatMap((plan, fleet) => JointPlanning.of(fleet, settings.loopSettings(plan)).left.toOption)
          .headOption
          .map("predictor: " + _)

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

  private given ConfigReader[LatencyProfile]             = parsed(LinkText.profile)

  private def parsed[A](parse: String => Either[String, A]): ConfigReader[A] =
    ConfigReader[String].emap(text => parse(text).left.map(CannotConvert(text, "setting", _)))
