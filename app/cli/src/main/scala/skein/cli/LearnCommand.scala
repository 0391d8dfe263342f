package skein.cli

import java.nio.file.{Files, Path}
import mainargs.{Flag, ParserForClass, arg}
import skein.environment.EnvironmentSettings
import skein.flight.NotFlown
import skein.learn.LearnerSettings
import skein.optimise.{Evaluator, Objective, RunningStats}
import skein.measure.FlightSummary
import skein.policy.{NeuralShape, Role}
import skein.report.{Section, Typed}
import skein.scenario.{PaperDuel, Scenarios}
import skein.search.{ClusterEvaluator, Conditions, Effort, Judge, NamedFiles, VerifiedQuestion}
import skein.settings.{PolicyFile, ScenarioSettings, VehicleChoice}
import skein.training.*
import skein.units.Decimals.significant
import skein.units.{Expect, Span}

/** Command-line options of `./skein learn`, with their help texts. */
final case class LearnOptions(
    @arg(doc = "sac, ddpg or ppo (default: sac)")
    algorithm: Option[String],
    @arg(doc =
      "the scenario to learn in: the duel, or any with pursuers and evaders; " +
        "one policy is learned for all of the side (default: duel)"
    )
    scenario: Option[String],
    @arg(doc = "a setting of the scenario, for example vehicles=8; can be repeated")
    set: Seq[String],
    @arg(doc = "the side that learns: pursuer or evader (default: pursuer)")
    side: Option[String],
    @arg(doc = "the latency profile: none, direct, vpn, constant:200ms, … (default: vpn)")
    link: Option[String],
    @arg(doc = "time between decisions for one vehicle (default: 100ms)")
    period: Option[String],
    forward: ForwardOptions,
    @arg(doc =
      "decisions to learn from, of all environments together, rounded up to whole rounds (default: 600000; ppo: 2000000)"
    )
    steps: Option[Long],
    @arg(doc = "widths of the hidden layers of all networks (default: 32x32)")
    network: Option[String],
    @arg(doc = "environments side by side during learning (default: 64)")
    environments: Option[Int],
    @arg(doc = "length of a training episode (default: 20s)")
    lesson: Option[String],
    @arg(doc =
      "distance between the vehicles at the start of a training episode, in metres (default: 3..30); in " +
        "scenarios other than the duel, distance of each vehicle from the scenario's start (default: 0..5)"
    )
    start: Option[String],
    @arg(doc = "the largest turn rate, rad/s (default: 3, as for families of search)")
    turnRate: Option[Double],
    @arg(doc =
      "the largest vertical speed, m/s: the policy climbs and sinks, by --plant tilt or quadrotor (default: 0, it keeps its altitude)"
    )
    climb: Option[Double],
    @arg(doc = "learning rate of Adam (default: 0.001; ppo: 0.0003)")
    learningRate: Option[Double],
    @arg(doc = "discount of a reward per decision (default: 0.98; ppo and evaders: 0.99)")
    discount: Option[Double],
    @arg(doc = "transitions of an update (default: 256)")
    batch: Option[Int],
    @arg(doc = "updates of sac and ddpg for each decision of one environment (default: 0.125)")
    updatesPerStep: Option[Double],
    @arg(doc = "episodes on which a policy is evaluated during learning (default: 20)")
    episodes: Option[Int],
    @arg(doc = "fresh episodes on which the best policy is measured at the end (default: 1000)")
    fresh: Option[Int],
    @arg(doc = "flights in virtual time with the final policy, under the same loop and link (default: 20)")
    flights: Option[Int],
    cluster: ClusterOptions,
    @arg(doc = "folder for state, policy and learning curve; without it, learned/DATE-TIME")
    out: Option[String],
    @arg(doc =
      "a folder whose learning was stopped: continues it, with the result of learning that was not stopped"
    )
    resume: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** @param program the class whose `main` starts the commands
  */
final class LearnCommand(program: String)(using Scenarios)
    extends Command[LearnOptions](
      "learn",
      "trains a neural policy by SAC, DDPG or PPO in forward simulation under a loop's real timing",
      ParserForClass[LearnOptions]
    ):

  import LearnCommand.Measuring

  override protected def check(options: LearnOptions): Either[String, Unit] =
    LearnCommand.question(options).flatMap(_.setup).map(_ => ())

  protected def execute(options: LearnOptions): Either[String, Unit] =
    val flights = options.flights.getOrElse(20)
    for
      threads <- options.forward.threadCount
      _       <- Expect.within("--flights", flights, 0, 10_000)
      cluster <- options.cluster.checked
      begun   <- options.resume.fold(begin(options))(resume(options, _))
      (folder, setup, state) = begun
      _ <- OutFolder.alone(folder):
        val shown = Shown(options.json.value)
        measuring(setup, cluster, folder, threads, shown): measure =>
          run(setup, folder, state, threads, flights, measure, shown)
    yield ()

  private type Begun = (Path, LearnSetup, LearnState)

  private def resume(options: LearnOptions, folder: String): Either[String, Begun] =
    val may = Arguments.told(options.cluster) ++ Set("--threads", "--flights", "--json")
    for
      _     <- Arguments.resumed(options, may, "--threads, --flights and who judges")
      file  <- LearnFile.read(Path.of(folder)).left.map("--resume: " + _)
      _     <- NamedFiles.unchanged(file.files, "learning")
      setup <- file.question.setup
      _     <- VerifiedQuestion.unchanged(file.probe, setup.probe, "learning")
    yield (Path.of(folder), setup, file.state)

  private def begin(options: LearnOptions): Either[String, Begun] =
    val folder = Path.of(options.out.getOrElse(OutFolder.dated("learned")))
    for
      setup <- LearnCommand.question(options).flatMap(_.setup)
      _     <- setup.task
      _     <- Expect.that(!Files.exists(folder.resolve(LearnFile.Name))):
        s"--out: $folder holds what was learned already; --resume ${Typed.path(folder)} goes on with it"
      _ <- OutFolder.made("--out", folder.toString)
    yield (folder, setup, LearnState())

  private def run(
      setup: LearnSetup,
      folder: Path,
      from: LearnState,
      threads: Int,
      flights: Int,
      measure: Measuring,
      shown: Shown
  ): Either[String, Unit] =
    import setup.question
    shown.say(
      s"""${question.algorithm} teaches the ${question.role} ${setup.family.name} ${against(setup)}
         |loop ${question.conditions.loopText} every ${question.conditions.periodMs.significant(
          4
        )} ms over ${question.link}; ${setup.conditions.vehicle.description}
         |${question.environments} environments, ${steps(setup)}; engine: ${setup.engine.fold(
          identity,
          _.text
        )}""".stripMargin
    )
    @volatile var stopped = false
    Edge.untilInterrupted(() => stopped = true):
      val startedAt = System.nanoTime()
      val line      = ProgressLine(setup.rounds, Console.err, from.rounds)
      val judge     = measure.judge(Judge.Candidates)
      val learned   = LearnRun(setup, judge, Some(folder), () => System.nanoTime(), measure.isElsewhere)
        .run(from, threads, () => stopped): state =>
          line.show(state.rounds, progress(setup, state))
      line.end()
      learned.flatMap: end =>
        import end.state
        val seconds = (System.nanoTime() - startedAt) * 1e-9
        val steps   = (state.rounds - from.rounds) * setup.stepsOfRound
        if steps > 0 || end.failure.isEmpty then
          shown.say(f"$steps%,d steps in $seconds%.1f s, ${steps / seconds.max(1e-3)}%,.0f a second")
        val isDone = state.rounds == setup.rounds
        val goOn   = s"stopped; ./skein learn --resume ${Typed.path(folder)} goes on"
        end.failure match
          case Some(reason) =>
            // Not measured: a failure may occur again.
            LearnResult.unmeasured(setup, state).fold(Right(())): file =>
              OutFolder.write(folder, Seq(OutFolder.text("policy.conf", file))).map: written =>
                shown.say(s"ended early; the best policy until then: ${written.mkString}")
            .flatMap(_ => Left(reason))
          case None if state.best.isEmpty => Right(shown.tables(Nil, goOn))
          case None                       =>
            // Before measuring, which may be cut short, since a user who stops a run does not wait long.
            if !isDone then shown.say(goOn)
            conclude(setup, measure, folder, state, if isDone then flights else 0, shown)

  private def against(setup: LearnSetup) = setup.game.opponent match
    case Some(opponent) => s"against ${opponent.label}"
    case None           =>
      val sharing = setup.game.scenario.agents.count(_.role == setup.role)
      s"of ${setup.game.scenario.title}, which " +
        s"${if sharing == 1 then "one flies" else s"$sharing fly"}; ${setup.game.text}"

  private def steps(setup: LearnSetup): String =
    val flown   = setup.rounds * setup.stepsOfRound
    val rounded =
      if flown == setup.question.steps then "" else f" (${setup.question.steps}%,d in whole rounds)"
    f"$flown%,d steps$rounded"

  private def progress(setup: LearnSetup, state: LearnState): String =
    val unit = setup.game.unit
    state.best.fold("not judged yet"): best =>
      s"now ${state.scores.last.mean.significant(4)} $unit, best ${best.mean.significant(4)} $unit"

  /** Evaluates the best policy and writes it and the learning curve. */
  private def conclude(
      setup: LearnSetup,
      measure: Measuring,
      folder: Path,
      state: LearnState,
      flights: Int,
      shown: Shown
  ): Either[String, Unit] =
    val most   = if state.rounds == setup.rounds then Int.MaxValue else LearnCommand.FreshIfStopped
    val result = LearnResult.measured(setup, measure.judge, state, setup.question.fresh.min(most))
    for
      file  <- OutFolder.write(folder, Seq(OutFolder.text("policy.conf", result.file)))
      flown <- if flights == 0 then Right(None) else virtual(setup, measure, result.policy, flights, shown)
      all = result.copy(flights = flown)
      _   = shown.tables(Seq(all.section), Section.text(Seq(all.section)))
      pictures <- OutFolder.write(
        folder,
        OutFolder.picture("learning-curve", all.curve, s"Learning curve of ${setup.question.algorithm}") :+
          OutFolder.text("learning-curve.csv", all.csv)
      )
    yield shown.say(s"written: ${(file ++ pictures).mkString(", ")}")

  /** Runs the policy in virtual time, against the scenario's own policy of the other role. */
  private def virtual(
      setup: LearnSetup,
      measure: Measuring,
      policy: PolicyFile,
      flights: Int,
      shown: Shown
  ): Either[String, Option[RunningStats]] =
    if !setup.isFlownAsTaught then
      shown.say(
        "no flights: they are flown against the paper's policy, and this one was not trained against it"
      )
      Right(None)
    else measure.distances(policy, flights).map(distances => Some(RunningStats.of(distances.size)(distances)))

  /** Chooses who evaluates the learned policy: this process, or workers, with identical bits. */
  private def measuring(
      setup: LearnSetup,
      options: Option[ClusterOptions.Checked],
      folder: Path,
      threads: Int,
      shown: Shown
  )(body: Measuring => Either[String, Unit]): Either[String, Unit] = options match
    case None =>
      body(Measuring(
        setup.judges(threads),
        LearnCommand.flown(setup, _, _),
        isElsewhere = false
      ))
    case Some(asked) =>
      val posed = QuestionKind.Learn.of(LearnWork.question(setup))
      ClusterRun.using(asked, program, posed, folder, threads, shown): run =>
        val line               = ProgressLine(100, Console.err)
        def wait(): Unit       = line.show((100 * run.share).toLong, run.status)
        def judge(from: Judge) = ClusterEvaluator(
          LearnWork.episodes(run),
          from,
          asked.block.getOrElse(Effort.blockEpisodes(isFast = true, setup.conditions.vehicle)),
          // Learning, which goes on meanwhile, has a line of its own.
          _ => if from != Judge.Candidates then wait()
        )
        def distances(policy: PolicyFile, count: Int) =
          LearnWork.distances(run, policy, count)(wait()).map(_.flatten)
        try body(Measuring(judge, distances, isElsewhere = true))
        finally line.end()

object LearnCommand:
  /** Maximum number of fresh episodes that evaluate the best policy of a stopped run. */
  private val FreshIfStopped = 100

  /** The question of the options.
    *
    * @return Left says what was expected, what was given, and in which option
    */
  def question(options: LearnOptions)(using scenarios: Scenarios): Either[String, LearnQuestion] =
    val climbMps = options.climb.getOrElse(0.0)
    val forward  =
      if climbMps > 0 then
        options.forward.copy(plant = options.forward.plant.orElse(Some(VehicleChoice.Tilt)))
      else options.forward
    val algorithm = options.algorithm.getOrElse("sac")
    val onPolicy  = algorithm == "ppo"
    val scenario  = options.scenario.orElse(scenarios.firstWithoutGame).getOrElse(PaperDuel.Name)
    for
      _ <- Expect.that(!onPolicy || options.updatesPerStep.isEmpty)(
        "--updates-per-step: expected with sac or ddpg, got ppo"
      )
      named <- Arguments.settings(options.set)
      set    = named.toMap
      isGame = scenarios.isPapersGame(scenario, set)
      role       <- PolicyFile.role(options.side.getOrElse("pursuer")).left.map("--side: " + _)
      period     <- Span.parse(options.period.getOrElse("100ms")).left.map("--period: " + _)
      lesson     <- Span.parse(options.lesson.getOrElse("20s")).left.map("--lesson: " + _)
      plain      <- forward.conditions(period, ForwardOptions.durationOf(scenario, set))
      conditions <- if isGame then Right(plain) else ofTeam(scenario, set, forward, plain)
      opponent   <- forward.opponentOf(role)
      shape      <- NeuralShape.parse(options.network.getOrElse("32x32")).left.map("--network: " + _)
      start      <- range(options.start.getOrElse(if isGame then "3..30" else "0..5"))
      usual = Option.when(isGame)("last10s")
      objective <- ForwardOptions.objectiveOf(forward.objective.orElse(usual), scenario, set)(
        Objective.measures(_).collect { case (key, measure) if EnvironmentSettings.rewards(measure) => key }
      )
    yield LearnQuestion(
      algorithm,
      PolicyFile.name(role),
      objective,
      conditions,
      options.link.getOrElse("vpn"),
      opponent.text,
      options.steps.getOrElse(if onPolicy then 2_000_000L else 600_000L),
      options.environments.getOrElse(64),
      lesson.toSeconds,
      start._1,
      start._2,
      options.turnRate.getOrElse(3.0),
      LearnerSettings(
        hidden = shape.hidden,
        discount = options.discount.getOrElse(if onPolicy || role == Role.Evader then 0.99 else 0.98),
        rate = options.learningRate.getOrElse(if onPolicy then 3e-4 else 1e-3),
        batch = options.batch.getOrElse(256),
        updatesPerStep = options.updatesPerStep.getOrElse(0.125)
      ),
      options.episodes.getOrElse(20),
      options.fresh.getOrElse(1000),
      forward.seed.getOrElse(1),
      scenario,
      set,
      climbMps
    )

  /** Conditions of a scenario's team, at its altitude. */
  private def ofTeam(
      scenario: String,
      set: Map[String, String],
      forward: ForwardOptions,
      conditions: Conditions
  )(using scenarios: Scenarios): Either[String, Conditions] =
    for
      _      <- ForwardOptions.ofDuels()(forward)
      kind   <- scenarios.kind(scenario).left.map("--scenario: " + _)
      stated <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
    // Teams fly low, where the model of three parameters is not valid.
    yield conditions.copy(
      plant = forward.plant.getOrElse("drag"),
      altitudeM = Conditions.altitudeM(stated)
    )

  private def range(text: String): Either[String, (Double, Double)] =
    text.split("\\.\\.", -1).map(_.toDoubleOption) match
      case Array(Some(least), Some(most)) if least >= 0 && most >= least && most <= 1000 =>
        Right((least, most))
      case _ => Left(s"--start: expected LEAST..MOST in metres, for example 3..30, got '$text'")

  /** Evaluates learned policies.
    *
    * @param distances simulates a number of virtual flights with a policy, and returns their results
    *   ([[LearnGame.came]])
    * @param isElsewhere whether workers compute
    */
  private final case class Measuring(
      judge: Judge => Evaluator,
      distances: (PolicyFile, Int) => Either[String, Vector[Double]],
      isElsewhere: Boolean
  )

  /** Results of virtual flights with a policy, run by this process. */
  private[skein] def flown(setup: LearnSetup, policy: PolicyFile, count: Int)(using
      Scenarios
  ): Either[String, Vector[Double]] = summaries(setup, policy, count).map(_.flatMap(setup.game.came))

  /** Summaries of virtual flights with a policy, run by this process. */
  private[skein] def summaries(setup: LearnSetup, policy: PolicyFile, count: Int)(using
      Scenarios
  ): Either[String, Vector[FlightSummary]] =
    for
      flights <- LearnWork.flights(setup, policy, count)
      (settings, plans) = flights
      (missing, landed) = SpreadFlights.fly(settings, plans).partitionMap(identity)
      _ <- Expect.that(missing.isEmpty)(NotFlown.message(missing, plans.size))
    yield landed
