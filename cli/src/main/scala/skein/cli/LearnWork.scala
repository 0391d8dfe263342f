package skein.cli

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.{BufferUnderflowException, ByteBuffer}
import scala.collection.immutable.ArraySeq
import skein.cluster.{Solver, Solvers}
import skein.loop.LoopKind
import skein.optimise.{RunningStats, ValueEvaluator}
import skein.scenario.Scenarios
import skein.search.*
import skein.settings.{ChosenPolicy, FlightPlan, FlySettings, PolicyFile}
import skein.training.{LearnQuestion, LearnSetup}
import skein.units.{Expect, Span}
import upickle.default.ReadWriter

/** What was learned, as workers measure it: on fresh episodes of forward simulation, and by flights in virtual time. */
private[cli] object LearnWork:
  import SearchFile.given

  /** @param probe
    *   what the baseline came to at the coordinator
    */
  private final case class ProbedQuestion(question: LearnQuestion, probe: Vector[RunningStats])
      derives ReadWriter

  private val Probes = 0 until 4

  private def probe(setup: LearnSetup) =
    setup.judges(threads = 1)(Judge.Baseline).tallies(Vector(setup.baseline.candidate), Probes)

  def question(setup: LearnSetup): ArraySeq[Byte] =
    JsonText.bytes(ProbedQuestion(setup.question, probe(setup)))

  def solvers(using Scenarios): Solvers = asked =>
    for
      posed <- JsonText.read[ProbedQuestion](asked, "learning's question")
      setup <- posed.question.setup
      came = probe(setup)
      _ <- Expect.that(came == posed.probe):
        s"the baseline comes to ${came.head.mean} here and to ${posed.probe.head.mean} at the coordinator; " +
          "has a file that --link or --plant names another content here?"
    yield () =>
      val by = setup.judges(threads = 1)
      work => answer(setup, by, work)

  private def answer(setup: LearnSetup, by: Judge => ValueEvaluator, work: ArraySeq[Byte])(using
      Scenarios
  ): ArraySeq[Byte] =
    def refuse(wrong: String) = throw IllegalArgumentException(wrong)
    work.headOption match
      case Some(Episodes) => SearchBlock.read(work.drop(1)).fold(refuse, _.answer(by))
      case Some(Flight)   => flightAnswer(setup, work.drop(1)).fold(refuse, identity)
      case other          => refuse(s"expected a block of learning, came one of the kind $other")

  /** Blocks of episodes, among others. */
  def episodes(run: BlockExecutor): BlockExecutor = new BlockExecutor:
    def cancel(): Unit                                                           = run.cancel()
    def compute(works: Vector[ArraySeq[Byte]], onAnswer: ArraySeq[Byte] => Unit) =
      run.compute(works.map(_.prepended(Episodes)), onAnswer)

  /** Flights of the scenario with a policy in the place of its own, as the commands fly it.
    *
    * @return
    *   settings, and a plan for each flight; or why there are none
    */
  def flights(
      setup: LearnSetup,
      policy: PolicyFile,
      count: Int
  ): Either[String, (FlySettings, Vector[FlightPlan])] =
    import setup.question as asked
    import asked.conditions
    for
      loop <- LoopKind.parse(conditions.loop)
      link <- Arguments.latency(asked.link)
    yield
      val settings = FlySettings(
        List(loop),
        List(link),
        Span.ofSeconds(conditions.durationS),
        Span.ofMillis(conditions.periodMs),
        asked.seed,
        setup.game.scenario
      )
      val plans =
        for plan <- settings.plansWith(ChosenPolicy(policy.name, policy)); number <- 0 until count
        yield plan.copy(seed = settings.seed + number)
      (settings, plans)

  /** What the same flights came to, flown elsewhere; none where a flight has no such value. */
  def distances(run: BlockExecutor, policy: PolicyFile, count: Int)(
      onWait: => Unit
  ): Either[String, Vector[Option[Double]]] =
    val numbers = policy.parameters
    val blocks  = Vector.tabulate(count): number =>
      val out = ByteBuffer.allocate(1 + 8 + 8 * numbers.size).put(Flight).putLong(number)
      numbers.foreach(out.putDouble)
      ArraySeq.unsafeWrapArray(out.array)
    run
      .computed(blocks)(onWait)
      .flatMap(_.toRight("no worker is left"))
      .flatMap(Expect.each(_)(distance))

  private def flightAnswer(setup: LearnSetup, work: ArraySeq[Byte])(using
      Scenarios
  ): Either[String, ArraySeq[Byte]] =
    val in = ByteBuffer.wrap(work.toArray)
    try
      val number  = in.getLong.toInt
      val weights = Vector.fill(in.remaining / 8)(in.getDouble)
      for (settings, plans) <-
          flights(setup, PolicyFile(setup.role, setup.family, weights), number + 1)
      yield SpreadFlights.one(settings, plans(number)) match
        case Left(missing) =>
          ArraySeq.from(missing.message.take(MostReason).getBytes(UTF_8)).prepended(NotFlown)
        case Right(flown) =>
          val out = ByteBuffer.allocate(9).put(Flown)
          setup.game.came(flown).foreach(out.putDouble)
          ArraySeq.unsafeWrapArray(out.array.take(out.position()))
    catch case _: BufferUnderflowException => Left(s"a flight's block is cut off after ${work.length} bytes")

  private def distance(answer: ArraySeq[Byte]): Either[String, Option[Double]] =
    answer.headOption match
      case Some(Flown) if answer.length == 9 => Right(Some(ByteBuffer.wrap(answer.toArray).getDouble(1)))
      case Some(Flown) if answer.length == 1 => Right(None)
      case Some(NotFlown)                    => Left(String(answer.tail.toArray, UTF_8))
      case other => Left(s"expected a flight's distance, came ${answer.length} bytes of the kind $other")

  private val Episodes: Byte = 0
  private val Flight: Byte   = 1
  private val Flown: Byte    = 0
  private val NotFlown: Byte = 1
  private val MostReason     = 16 << 10
