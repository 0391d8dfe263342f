package skein.settings

import skein.loop.{Fallback, LoopKind, PlanSettings, Replay}
import skein.measure.RecordedScenario
import skein.policy.Fleet
import skein.record.{Parameter, Recording}
import skein.scenario.Scenarios
import skein.signal.LatencyProfile
import skein.units.*

/** What a recording says was flown: enough to fly it again. */
final case class RecordedPlan(settings: FlySettings, plan: FlightPlan):
  def fleet: Fleet = plan.fleet(settings)

object RecordedPlan:
  private val Predictor = "predictor"

  /** Under which recordings of older versions keep it. */
  private val Model    = "model"
  private val Planning = "planning"

  private val MovesInFlight = "movesInFlight"
  private val DeadlineNs    = "deadlineNs"

  /** The policy's short name; what it is stands under its role, for example `policy.pursuer`. */
  val PolicyName = "policy"

  /** What [[of]] needs besides the columns that every recording has. */
  def parameters(settings: FlySettings, plan: FlightPlan): Seq[Parameter] =
    ScenarioSettings.recorded(settings.scenario) ++ NamedScene.recorded(settings.world) ++ Seq(
      Parameter(Planning, settings.planning.text),
      Parameter(Predictor, PredictionModel.text(settings.predictor)),
      Parameter(MovesInFlight, settings.movesInFlight.toString)
    ) ++ settings.deadline.toSeq.flatMap(deadline =>
      Seq(
        Parameter(DeadlineNs, deadline.toNanos.toString),
        Parameter(Replay.Fallback, settings.fallback.label)
      )
    ) ++
      plan.policy.toSeq.flatMap: chosen =>
        Seq(
          Parameter(PolicyName, chosen.name),
          Parameter(s"$PolicyName.${PolicyFile.name(chosen.file.role)}", chosen.file.text)
        )

  /** Reads it back.
    *
    * @return
    *   or what is missing, or is not what `skein fly` records
    */
  def of(recording: Recording)(using Scenarios): Either[String, RecordedPlan] =
    val flight     = recording.flight
    val parameters = recording.heading.parameters.map(parameter => parameter.name -> parameter.value).toMap

    def parameter[A](name: String, expected: String)(parse: String => Option[A]): Either[String, A] =
      parameters.get(name) match
        case None        => Left(s"the recording has no parameter '$name'")
        case Some(value) => parse(value).toRight(s"its parameter '$name': expected $expected, came '$value'")

    /** Recordings of older versions have not got all. */
    def optional[A](name: String, expected: String)(parse: String => Option[A]): Either[String, Option[A]] =
      if parameters.contains(name) then parameter(name, expected)(parse).map(Some(_)) else Right(None)

    for
      loop     <- LoopKind.parse(flight.loop)
      link     <- LatencyProfile.parse(flight.link, TextFile.read).left.map(_.message)
      now      <- optional(Predictor, "a model's name or five numbers")(PredictionModel.recorded)
      older    <- optional(Model, "a model's name or five numbers")(PredictionModel.recordedAsModel)
      moves    <- optional(MovesInFlight, "a number from 1")(_.toIntOption.filter(_ > 0))
      within   <- optional(DeadlineNs, "nanoseconds")(_.toLongOption.filter(_ > 0))
      fallback <- optional(Replay.Fallback, "hold, repeat or a policy")(Fallback.parse(_).toOption)
      // Recordings from before there was planning have none.
      planning <-
        if parameters.contains(Planning) then parameter(Planning, "settings of plans")(PlanSettings.parse)
        else Right(PlanSettings())
      scenario <- RecordedScenario.of(recording)
      scene    <- NamedScene.ofRecording(parameters)
      settings = FlySettings(
        List(loop),
        List(link),
        flight.duration,
        flight.period,
        flight.seed,
        scenario,
        planning = planning
      )
      policy <- policyOf(parameters.get(PolicyName), recording.heading.parametersOf(PolicyName))
    yield RecordedPlan(
      settings.copy(
        predictor = now.orElse(older).getOrElse(settings.predictor),
        movesInFlight = moves.getOrElse(settings.movesInFlight),
        deadline = within.map(Span.ofNanos),
        fallback = fallback.getOrElse(settings.fallback),
        scene = Some(scene)
      ),
      FlightPlan(flight.id, loop, link, flight.seed, policy)
    )

  private def policyOf(
      name: Option[String],
      byRole: Map[String, String]
  ): Either[String, Option[ChosenPolicy]] =
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
