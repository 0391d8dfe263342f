package skein.cli

import com.typesafe.config.{Config, ConfigException, ConfigFactory, ConfigRenderOptions}
import scala.collection.immutable.ArraySeq
import scala.jdk.CollectionConverters.*
import skein.bytes.Codec
import skein.cluster.{BlockSolver, BlockSolverFactory}
import skein.flight.{NotFlown, VirtualFlights}
import skein.measure.{FlightSummary, SummaryBytes}
import skein.pickle.Fields
import skein.scenario.Scenarios
import skein.search.{BlockBytes, BlockExecutor, JsonText}
import skein.settings.{FlightPlan, FlySettings}
import skein.units.{Expect, Span}

/** A spread's flights as workers receive them. A block is one flight: the index of a plan of the settings,
  * and a seed.
  *
  * @param settings `skein.fly`, as JSON
  * @param probe digests of short flights: a worker with other digests must not take part
  */
private[cli] final case class SpreadQuestion(settings: String, probe: Vector[String]) derives Fields:
  def bytes: ArraySeq[Byte] = JsonText.bytes(this)

private[cli] object SpreadQuestion:

  /** @param config `skein.fly`, from which the settings were read
    * @return Left says why other processes cannot run it
    */
  def of(config: Config, settings: FlySettings): Either[String, SpreadQuestion] =
    val outside = config.getStringList("skein.fly.policies").asScala.find(_.startsWith("unix:"))
    outside match
      case Some(policy) =>
        Left(s"--policy $policy: a process of this machine, whom workers cannot ask; expected a policy file")
      case None =>
        probe(settings).map(SpreadQuestion(config.root.render(ConfigRenderOptions.concise), _))

  /** Digests of short flights, which differ if the files of another machine differ. A recording begins with
    * policies, models and scenes; links affect only vehicles.
    */
  private def probe(settings: FlySettings): Either[String, Vector[String]] =
    val plans = settings.plans
    val each  = (plans.distinctBy(_.link) ++ plans.distinctBy(_.policy)).distinct
    val short = settings.copy(duration = settings.duration.min(ProbeDuration))
    val flown = VirtualFlights.inParallel(short, each)(_.recorder.digest.toString)
    Expect.each(flown)(_.left.map(_.message))

  private val ProbeDuration = Span.ofSeconds(1)

  /** Runs flights of scenarios known to this process. */
  def solvers(using Scenarios): BlockSolverFactory = asked =>
    for
      question <- JsonText.read[SpreadQuestion](asked, "spread's question")
      config   <-
        try Right(ConfigFactory.parseString(question.settings))
        catch case mistake: ConfigException => Left(mistake.getMessage)
      settings <- FlySettings.read(config)
      came     <- probe(settings)
      _        <- Expect.that(came == question.probe):
        "short flights are others here than at the coordinator; has a file that " +
          "--link, --policy, --predictor or --scene names another content here?"
    yield () => (Ready(settings).answer(_)): BlockSolver

  final case class Ready(settings: FlySettings)(using Scenarios):
    private val plans = settings.plans

    /** The flights of each plan with `seeds` seeds, in the plans' order. */
    def flights(seeds: Int): Vector[FlightPlan] =
      for plan <- plans; number <- Vector.range(0, seeds) yield plan.copy(seed = settings.seed + number)

    /** Has flights run by other processes. A flight whose summary does not fit into a message is run here,
      * and reported.
      *
      * @param onLanded called once for each flight, in any order
      */
    def elsewhere(by: BlockExecutor, seeds: Int, tell: String => Unit)(onLanded: => Unit)(
        onWait: => Unit
    ): Either[String, Vector[Either[NotFlown, FlightSummary]]] =
      val flown = flights(seeds)
      by.computed(blocks(seeds), onAnswer = _ => onLanded)(onWait)
        .flatMap(_.toRight("no worker is left"))
        .flatMap(Expect.each(_)(BlockBytes.read[FlightAnswer](_, "a flight's answer")))
        .flatMap: answers =>
          val large = answers.count(_ == FlightAnswer.TooLarge)
          if large > 0 then
            tell(s"$large of ${flown.size} flights are too large for a message and are flown here again")
          Expect.each(flown.zip(answers))(landed(_, _))

    private def blocks(seeds: Int): Vector[ArraySeq[Byte]] =
      for place <- plans.indices.toVector; number <- Vector.range(0, seeds)
      yield BlockBytes.of((place, settings.seed + number))

    def answer(block: ArraySeq[Byte]): ArraySeq[Byte] =
      val (place, seed) = BlockBytes
        .read[(Int, Long)](block, "a flight's place and seed")
        .fold(wrong => throw IllegalArgumentException(wrong), identity)
      require(plans.isDefinedAt(place), s"expected one of ${plans.size} plans, got $place")
      BlockBytes.of:
        SpreadFlights.one(settings, plans(place).copy(seed = seed)) match
          case Left(missing)  => FlightAnswer.NotFlown(missing.reason.take(MostReason))
          case Right(summary) =>
            val bytes = SummaryBytes.write(summary)
            if bytes.length > MostBytes then FlightAnswer.TooLarge else FlightAnswer.Flown(bytes)

    private def landed(
        plan: FlightPlan,
        answer: FlightAnswer
    ): Either[String, Either[NotFlown, FlightSummary]] = answer match
      case FlightAnswer.Flown(summary)   => SummaryBytes.read(summary, Some(settings.scenario)).map(Right(_))
      case FlightAnswer.NotFlown(reason) => Right(Left(NotFlown(plan, reason)))
      case FlightAnswer.TooLarge         => Right(SpreadFlights.one(settings, plan))

  /** A worker's answer: the result of one flight. */
  private[cli] enum FlightAnswer derives Codec:
    /** The summary, encoded as [[SummaryBytes]]. */
    case Flown(summary: ArraySeq[Byte])
    case NotFlown(reason: String)

    /** The summary does not fit into a message. */
    case TooLarge

  private val MostReason = 16 << 10

  /** Maximum size of an encoded answer in bytes, so that it fits into a message. */
  private val MostBytes = 600 << 10
