package skein.cli

import java.nio.file.{Files, Path}
import mainargs.{Flag, ParserForClass, arg}
import skein.gpu.CudaGpu
import skein.lanes.gpu.GpuAccelerator
import skein.optimise.{CmaEs, ScenarioTerm}
import skein.policy.PolicyFamily
import skein.report.Typed
import skein.scenario.Scenarios
import skein.search.*
import skein.settings.PolicyFile
import skein.simd.LaneFunction
import skein.units.{Expect, Span}

/** Command-line options of `./skein search`, with their help texts. */
final case class SearchOptions(
    @arg(doc = "family of policies to search (default: paper-pursuer)")
    family: Option[String],
    @arg(doc = "pursuer or evader, for families that suit both")
    role: Option[String],
    @arg(doc = "grid, random, cross-entropy, cma-es or racing (default: cma-es)")
    method: Option[String],
    @arg(doc = "the latency profile: none, direct, vpn, constant:200ms, … (default: vpn)")
    link: Option[String],
    @arg(doc = "time between decisions for one vehicle (default: 100ms)")
    period: Option[String],
    @arg(doc = "candidates to try in all (default: 1000; 40 with flights in virtual time)")
    candidates: Option[Int],
    @arg(doc =
      "episodes of each candidate; when racing, of the first " +
        "round (default: 20; 2 with flights in virtual time)"
    )
    episodes: Option[Int],
    @arg(doc =
      "candidates in a generation of cma-es and cross-entropy (default: 40, or more for many parameters; " +
        "of a scenario 128; 10 with flights in virtual time)"
    )
    population: Option[Int],
    @arg(doc =
      "fresh episodes on which the winner is measured (default: 4096 with a reduced model by " +
        "SIMD, fewer where an episode costs more; of a scenario 256; 16 with flights in virtual time); also the most for each point of the landscape"
    )
    fresh: Option[Int],
    @arg(doc =
      "searches settings of this scenario, a team's, instead of a " +
        "duel's policy; the command scenarios lists them"
    )
    scenario: Option[String],
    @arg(doc = "a setting of the scenario, for example vehicles=8; can be repeated")
    set: Seq[String],
    @arg(doc = "a setting of the scenario to search; can be repeated")
    vary: Seq[String],
    forward: ForwardOptions,
    @arg(doc = "candidates fly on this machine's NVIDIA GPU; does not change the result")
    gpu: Flag,
    cluster: ClusterOptions,
    @arg(doc = "folder for state, policy and pictures; without it, searches/DATE-TIME")
    out: Option[String],
    @arg(doc =
      "a folder whose search was stopped: continues it, with the result of a search that was not stopped"
    )
    resume: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** @param program the class whose `main` starts the commands
  */
final class SearchCommand(program: String)(using scenarios: Scenarios)
    extends Command[SearchOptions](
      "search",
      "finds the best of many policies by forward simulation under a loop's real timing",
      ParserForClass[SearchOptions]
    ):

  override protected def known: Map[String, Seq[String]] =
    Map("family" -> (PolicyFamily.all ++ scenarios.families).map(_.name))

  override protected def check(options: SearchOptions): Either[String, Unit] = question(options).map(_ => ())

  protected def execute(options: SearchOptions): Either[String, Unit] =
    val shown = Shown(options.json.value)
    for
      threads <- options.forward.threadCount
      cluster <- options.cluster.checked
      _       <- Expect.that(!options.gpu.value || cluster.isEmpty):
        "--gpu: expected without --workers and --cluster, whose processes fly on processors"
      accelerator <- if options.gpu.value then
        CudaGpu.find().map(gpu => Some(GpuAccelerator(gpu))).left.map("--gpu: " + _)
      else Right(None)
      begun <- options.resume.fold(begin(options))(resume(options, _))
      (folder, asked, stored) = begun
      ready                   = asked.acceleratedBy(accelerator)
      _ <- Expect.that(accelerator.isEmpty || ready.fliesForward):
        "--gpu: expected what forward simulation flies; these are flights in virtual time"
      _ <- OutFolder.alone(folder):
        EpisodeRunner.using(cluster, program, ready, folder, threads, shown): runner =>
          SearchJob(ready, folder, threads, runner, shown).run(stored)
    yield ()

  private type Begun = (Path, ReadySearch, Option[SearchFile])

  private def resume(options: SearchOptions, folder: String): Either[String, Begun] =
    val may = Arguments.told(options.cluster) ++ Set("--threads", "--gpu", "--json")
    for
      _     <- Arguments.resumed(options, may, "--threads and who computes")
      file  <- SearchFile.read(Path.of(folder)).left.map("--resume: " + _)
      _     <- NamedFiles.unchanged(file.files, "the search")
      ready <- file.question.setup
    yield (Path.of(folder), ready, Some(file))

  private def begin(options: SearchOptions): Either[String, Begun] =
    val folder = Path.of(options.out.getOrElse(OutFolder.dated("searches")))
    for
      ready <- question(options)
      _     <- Expect.that(!Files.exists(folder.resolve(SearchFile.Name))):
        s"--out: $folder holds a search already; --resume ${Typed.path(folder)} goes on with it"
      _ <- OutFolder.made("--out", folder.toString)
    yield (folder, ready, None)

  private def question(options: SearchOptions): Either[String, ReadySearch] =
    for
      _ <- Expect.that(options.population.isEmpty || options.method.forall(SearchQuestion.WithPopulation)):
        s"--population: expected with ${SearchQuestion.WithPopulation.mkString(" or ")}, " +
          s"got ${options.method.mkString}"
      ready <- options.scenario.orElse(scenarios.firstWithoutGame).fold(duel(options))(team(options, _))
    yield ready

  private def team(options: SearchOptions, scenario: String): Either[String, ReadySearch] =
    import options.forward
    for
      _         <- ForwardOptions.ofDuels("--family" -> options.family, "--role" -> options.role)(forward)
      set       <- Arguments.settings(options.set)
      objective <- ForwardOptions.objectiveOf(forward.objective, scenario, set.toMap)(
        _.measures.map(ScenarioTerm.keyOf)
      )
      period     <- Span.parse(options.period.getOrElse("100ms")).left.map("--period: " + _)
      conditions <- forward.conditions(period, ForwardOptions.durationOf(scenario, set.toMap))
      vary       <- Expect.all(options.vary)(Varied.parse(_).left.map("--vary: " + _))
      candidates = options.candidates.getOrElse(1000)
      question   = TeamQuestion(
        scenario,
        set.toMap,
        vary.toVector,
        objective,
        options.method.getOrElse("cma-es"),
        conditions.copy(plant = forward.plant.getOrElse(TeamQuestion.Plant)),
        options.link.getOrElse("vpn"),
        candidates,
        options.episodes.getOrElse(20),
        options.population.getOrElse(LaneFunction.COUNT.min(candidates.max(4))),
        forward.seed.getOrElse(1),
        options.fresh.getOrElse(Effort.TeamsFresh)
      )
      read  <- question.read(forward.plant.isDefined)
      ready <- (if read.isVirtual then inFlights(question, options) else question).setup
    yield ready

  /** Sets smaller defaults for an engine that evaluates only some candidates per second. */
  private def inFlights(question: TeamQuestion, options: SearchOptions): TeamQuestion =
    val candidates = options.candidates.getOrElse(40)
    question.copy(
      candidates = candidates,
      episodes = options.episodes.getOrElse(2),
      population = options.population.getOrElse(10.min(candidates.max(4))),
      fresh = options.fresh.getOrElse(Effort.OfFlights.freshEpisodes)
    )

  private def duel(options: SearchOptions): Either[String, ReadySearch] =
    import options.forward
    for
      _ <- Expect.that(options.set.isEmpty && options.vary.isEmpty):
        "--set, --vary: expected with --scenario, whose settings they are"
      family     <- scenarios.family(options.family.getOrElse("paper-pursuer")).left.map("--family: " + _)
      role       <- PolicyFile.roleOf(family, options.role).left.map("--role: " + _)
      period     <- Span.parse(options.period.getOrElse("100ms")).left.map("--period: " + _)
      conditions <- forward.conditions(period)
      opponent   <- forward.opponentOf(role)
      candidates = options.candidates.getOrElse(1000)
      question   = SearchQuestion(
        family.name,
        PolicyFile.name(role),
        forward.objective.getOrElse("last10s"),
        options.method.getOrElse("cma-es"),
        conditions,
        options.link.getOrElse("vpn"),
        opponent.text,
        candidates,
        options.episodes.getOrElse(20),
        options.population.getOrElse(
          CmaEs.defaultPopulation(family.space.dimension).max(40).min(candidates.max(4))
        ),
        forward.seed.getOrElse(1),
        options.fresh
      )
      ready <- question.setup
    yield ready
