package skein.cli

import scala.collection.immutable.ArraySeq
import skein.bytes.Codec
import skein.cluster.{BlockSolver, BlockSolverFactory}
import skein.loop.LoopKind
import skein.optimise.{RunningStats, ValueEvaluator}
import skein.pickle.Fields
import skein.scenario.Scenarios
import skein.search.*
import skein.settings.{ChosenPolicy, FlightPlan, FlySettings, PolicyFile}
import skein.training.{LearnQuestion, LearnSetup}
import skein.units.{Expect, Span}

/** Workers' evaluation of a learned policy: on fresh episodes of forward simulation, and by flights in
  * virtual time.
  */
private[cli] object LearnWork:
  import SearchFile.given

  /** @param probe the baseline's result at the coordinator */
  private final case class ProbedQuestion(question: LearnQuestion, probe: Vector[RunningStats])
      derives Fields

  def question(setup: LearnSetup): ArraySeq[Byte] =
    JsonText.bytes(ProbedQuestion(setup.question, setup.probe))

  def solvers(using Scenarios): BlockSolverFactory = asked =>
    for
      posed <- JsonText.read[ProbedQuestion](asked, "learning's question")
      setup <- posed.question.setup
      came = setup.probe
      _ <- Expect.that(RunningStats.areSame(came, posed.probe)):
        s"the baseline comes to ${came.head.mean} here and to ${posed.probe.head.mean} at the coordinator; " +
          "has a file that --link or --plant names another content here?"
    yield () =>
      val by = setup.judges(threads = 1)
      work => answer(setup, by, work)

  private def answer(setup: LearnSetup, by: Judge => ValueEvaluator, work: ArraySeq[Byte])(using
      Scenarios
  ): ArraySeq[Byte] =
    val answered = BlockBytes.read[Block](work, "a block of learning").flatMap:
      case Block.Episodes(block)         => SearchBlock.read(block).map(_.answer(by))
      case Block.Flight(number, numbers) => landed(setup, number, numbers).map(BlockBytes.of(_))
    answered.fold(wrong => throw IllegalArgumentException(wrong), identity)

  /** An executor that evaluates episodes on a shared cluster. */
  def episodes(run: BlockExecutor): BlockExecutor = new BlockExecutor:
    def cancel(): Unit                                                           = run.cancel()
    def compute(works: Vector[ArraySeq[Byte]], onAnswer: ArraySeq[Byte] => Unit) =
      run.compute(works.map(work => BlockBytes.of(Block.Episodes(work))), onAnswer)

  /** The flights of the scenario with a policy instead of its own, as the commands run them.
    *
    * @return settings, and a plan for each flight; Left says why there are none
    */
  def flights(
      setup: LearnSetup,
      policy: PolicyFile,
      count: Int
  ): Either[String, (FlySettings, Vector[FlightPlan])] =
    import setup.question as asked
    import asked.conditions
    for
      loop  <- LoopKind.parse(conditions.loop)
      link  <- Arguments.latency(asked.link)
      noise <- conditions.noise
    yield
      val settings = FlySettings(
        List(loop),
        List(link),
        Span.ofSeconds(conditions.durationS),
        Span.ofMillis(conditions.periodMs),
        asked.seed,
        setup.game.scenario,
        movesInFlight = conditions.movesInFlight,
        sensors = noise
      )
      val plans =
        for plan <- settings.plansWith(ChosenPolicy(policy.name, policy)); number <- 0 until count
        yield plan.copy(seed = settings.seed + number)
      (settings, plans)

  /** Results of these flights, run by other processes; None for a flight without a result. */
  def distances(run: BlockExecutor, policy: PolicyFile, count: Int)(
      onWait: => Unit
  ): Either[String, Vector[Option[Double]]] =
    val blocks = Vector.tabulate(count)(number => BlockBytes.of(Block.Flight(number, policy.parameters)))
    run
      .computed(blocks)(onWait)
      .flatMap(_.toRight("no worker is left"))
      .flatMap(Expect.each(_)(distance))

  private def landed(setup: LearnSetup, number: Int, parameters: Vector[Double])(using
      Scenarios
  ): Either[String, FlightAnswer] =
    for (settings, plans) <- flights(setup, PolicyFile(setup.role, setup.family, parameters), number + 1)
    yield SpreadFlights.one(settings, plans(number)) match
      case Left(missing) => FlightAnswer.NotFlown(missing.message.take(MostReason))
      case Right(flown)  => FlightAnswer.Flown(setup.game.came(flown))

  private def distance(answer: ArraySeq[Byte]): Either[String, Option[Double]] =
    BlockBytes.read[FlightAnswer](answer, "a flight's distance").flatMap:
      case FlightAnswer.Flown(came)      => Right(came)
      case FlightAnswer.NotFlown(reason) => Left(reason)

  private enum Block derives Codec:
    /** A block of a search's episodes, encoded. */
    case Episodes(block: ArraySeq[Byte])

    /** One flight with a policy of these parameters. */
    case Flight(number: Int, parameters: Vector[Double])

  private enum FlightAnswer derives Codec:
    case Flown(came: Option[Double])
    case NotFlown(reason: String)

  private val MostReason = 16 << 10
