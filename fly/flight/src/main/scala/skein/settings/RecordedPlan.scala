package skein.settings

import scala.annotation.tailrec
import skein.loop.{AnyLoop, LoopKind, PlanSettings, Replay}
import skein.loop.learning.{Learning, LessonsAgain, LearnerUpdate}
import skein.measure.RecordedScenario
import skein.policy.Fleet
import skein.port.Moves
import skein.record.{Event, EventKind, ParameterRow, Record, Recording}
import skein.scenario.Scenarios
import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.units.*

/** The settings and plan of a recorded flight: enough to repeat its decisions, and with
  * [[RecordedPlan.linkOf its link]] to repeat the flight.
  */
final case class RecordedPlan(settings: FlySettings, plan: FlightPlan):
  /** The agents of the flight, for repeated decisions. */
  def fleet: Fleet =
    val flown = plan.fleet(settings)
    plan.policy match
      case Some(chosen @ ChosenPolicy(_, _, Some(Learning.Again(explore, news)))) =>
        chosen.learningIn(flown, LessonsAgain(news), explore, plan.seed, settings.period)((_, _, _) => ())
      case _ => flown

object RecordedPlan:
  private val settings = RecordedSetting.fields[FlySettings]

  private val Predictor = "predictor"
  private val Planning  = "planning"

  /** The parameter for the policy's short name; the policy itself is under its role, for example
    * `policy.pursuer`.
    */
  val PolicyName = "policy"

  /** The parameter for the exploration of a policy that learned in flight. */
  private val Explore = "learningExplore"

  /** The parameter for the round trips of a link that a file gives, in ms, one a line. */
  private val Measured = "link.roundTripsMs"

  /** The prefix of a parameter that names the decision from which on a policy had other parameters. */
  private val Version = "version"

  /** The record of a learning policy's update.
    *
    * @param decision the number of the next one
    */
  def learned(at: Instant, vehicle: String, decision: Long, news: LearnerUpdate): Seq[Record] =
    news.parameters.map(parameters =>
      ParameterRow(s"$Version.$decision", Numbers64.text(parameters))
    ).toSeq :+
      Event(at, EventKind.Learned, Some(vehicle), news.text, Some(decision))

  /** The parameters that [[of]] needs in addition to the columns of every recording. */
  def parameters(flown: FlySettings, plan: FlightPlan): Seq[ParameterRow] =
    val deadline = flown.deadlineOf(plan)
    val ofFlight = flown.copy(
      scene = Some(flown.world),
      solver = plan.solver,
      deadline = deadline,
      onlyPolicies = false,
      knows = flown.loopSettings.knows,
      decentralised = flown.isDecentralised(plan),
      between = flown.between.filter(_ => flown.isDecentralised(plan))
    )
    val ofPolicy = plan.policy.toSeq.flatMap: chosen =>
      Seq(
        ParameterRow(PolicyName, chosen.name),
        ParameterRow(s"$PolicyName.${PolicyFile.name(chosen.file.role)}", chosen.file.text)
      ) ++ chosen.learning.map(learning => ParameterRow(Explore, learning.explore.toString))
    settings.written(ofFlight).filter(_.name != Replay.Fallback || deadline.isDefined) ++ ofPolicy ++
      measured(plan.link).map(each => ParameterRow(Measured, each.mkString("\n")))

  /** Round trips of a link that a file gives, ms. */
  @tailrec private def measured(link: LatencyProfile): Option[Vector[Double]] = link.delays match
    case LatencyProfile.Correlated(_, latency, _)     => measured(latency)
    case LatencyProfile.Steady(s"file:$_", roundTrip) => roundTrip match
        case LatencyDistribution.Quantiles(_, roundTripsMs) => Some(roundTripsMs)
        case other                                          => Some(Vector(other.mean.toMillis))
    case _ => None

  /** The link of a recorded flight, by its recorded round trips; older recordings name a file alone.
    *
    * @return Left says why the link is not known
    */
  def linkOf(recording: Recording): Either[String, LatencyProfile] =
    val recorded = recording.heading.parameters.find(_.name == Measured).map(_.value)
    LatencyProfile
      .parse(recording.flight.link, path => recorded.fold(TextFile.read(path))(Right(_)))
      .left.map(_.message)

  /** The parameters of a flight's planning.
    *
    * @param predictor absent if a recording cannot name it
    */
  def parameters(planning: PlanSettings, predictor: Option[PredictionModel]): Seq[ParameterRow] =
    RecordedSetting.written(Planning, planning) ++ RecordedSetting.written(Predictor, predictor)

  /** Reads the settings of a recording. A link that is not known, [[linkOf]], is none.
    *
    * @return Left says what is missing, or differs from what `skein fly` records
    */
  def of(recording: Recording)(using Scenarios): Either[String, RecordedPlan] =
    val flight     = recording.flight
    val parameters = recording.heading.parameters.map(parameter => parameter.name -> parameter.value).toMap
    for
      loop <- AnyLoop.parse(flight.loop)
      _    <- Expect.that(
        loop != LoopKind.Plan || Seq(Predictor, RecordedSetting.OlderPredictor).exists(parameters.contains)
      ):
        s"the recording has no parameter '$Predictor': by what model was planned is not known"
      scenario <- RecordedScenario.of(recording)
      link    = linkOf(recording).getOrElse(LatencyProfile.none)
      columns = FlySettings(List(loop), List(link), flight.duration, flight.period, flight.seed, scenario)
      flown   <- settings.read(parameters, columns)
      _       <- Moves.mistake(flown.movesInFlight).map("its parameter 'movesInFlight': " + _).toLeft(())
      chosen  <- policyOf(parameters.get(PolicyName), recording.heading.parametersOf(PolicyName))
      explore <- Expect.each(parameters.get(Explore)): text =>
        text.toDoubleOption.toRight(s"its parameter '$Explore': expected a number, got '$text'")
      news <- newsOf(recording)
      policy = chosen.map(_.copy(learning = explore.headOption.map(Learning.Again(_, news))))
    yield RecordedPlan(
      flown.copy(solver = None),
      FlightPlan(flight.id, loop, link, flight.seed, policy, flown.solver)
    )

  /** The recorded updates by decision; several before one decision are combined. */
  private def newsOf(recording: Recording): Either[String, Map[Long, Vector[LearnerUpdate]]] =
    val versions = recording.heading.parametersOf(Version)
    val said     = recording.events
      .filter(_.kind == EventKind.Learned)
      .flatMap(event => event.decision.map(_ -> LearnerUpdate(event.detail)))
      .groupMap(_._1)(_._2)
    versions.foldLeft[Either[String, Map[Long, Vector[LearnerUpdate]]]](Right(said)):
      case (before, (number, text)) =>
        for
          said     <- before
          decision <- number.toLongOption.filter(said.contains).toRight(
            s"its parameter '$Version.$number': expected a decision before which something was learned"
          )
          numbers <- Numbers64.parse(text).toRight(
            s"its parameter '$Version.$number': expected numbers in Base64, got others"
          )
        yield said.updated(
          decision,
          said(decision).init :+ said(decision).last.copy(parameters = Some(numbers))
        )

  private def policyOf(
      name: Option[String],
      byRole: Map[String, String]
  )(using Scenarios): Either[String, Option[ChosenPolicy]] =
    (name, byRole.toSeq) match
      case (None, _)                         => Right(None)
      case (Some(name), Seq((role, policy))) =>
        PolicyFile
          .role(role)
          .flatMap(PolicyFile.parse(_, policy))
          .map(file => Some(ChosenPolicy(name, file)))
          .left
          .map(mistake => s"its parameter '$PolicyName.$role': $mistake")
      case (Some(name), _) => Left(s"the recording names the policy '$name' and does not say what it is")
