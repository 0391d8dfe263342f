package skein.settings

import skein.loop.{AnyLoop, Fallback, LoopKind, PlanSettings, Replay}
import skein.loop.learning.{Learning, LessonsAgain, LearnerUpdate}
import skein.measure.{RecordedScenario, SolverSummary}
import skein.policy.Fleet
import skein.port.Moves
import skein.record.{Event, EventKind, ParameterRow, Record, Recording}
import skein.scenario.Scenarios
import skein.signal.LatencyProfile
import skein.units.*

/** What a recording says was flown: enough to fly it again. */
final case class RecordedPlan(settings: FlySettings, plan: FlightPlan):
  /** Who flew, and decides again. */
  def fleet: Fleet =
    val flown = plan.fleet(settings)
    plan.policy match
      case Some(chosen @ ChosenPolicy(_, _, Some(Learning.Again(explore, news)))) =>
        chosen.learningIn(flown, LessonsAgain(news), explore, plan.seed)((_, _, _) => ())
      case _ => flown

object RecordedPlan:
  private val Predictor = "predictor"

  /** Under which recordings of older versions keep it. */
  private val Model    = "model"
  private val Planning = "planning"

  private val MovesInFlight = "movesInFlight"
  private val DeadlineNs    = "deadlineNs"
  private val Images        = "images"
  private val Plant         = "plant"
  private val Spoken        = "wire"

  /** The policy's short name; what it is stands under its role, for example `policy.pursuer`. */
  val PolicyName = "policy"

  /** How a policy tried out that learned in flight. */
  private val Explore = "learningExplore"

  /** The word before the number of a decision from which on a policy had other parameters. */
  private val Version = "version"

  /** What is recorded of a policy that learns.
    *
    * @param decision the number of the next one
    */
  def learned(at: Instant, vehicle: String, decision: Long, news: LearnerUpdate): Seq[Record] =
    news.parameters.map(parameters =>
      ParameterRow(s"$Version.$decision", Numbers64.text(parameters))
    ).toSeq :+
      Event(at, EventKind.Learned, Some(vehicle), news.text, Some(decision))

  /** What [[of]] needs besides the columns that every recording has. */
  def parameters(settings: FlySettings, plan: FlightPlan): Seq[ParameterRow] =
    val deadline = settings.deadlineOf(plan)
    val told     = Seq[(String, Option[Any])](
      MovesInFlight           -> Some(settings.movesInFlight),
      Plant                   -> Option.when(!settings.plant.isAirSim)(settings.plant.text),
      Spoken                  -> Option.when(settings.wire != Wire.AirSim)(settings.wire.label),
      SolverSummary.Parameter -> plan.solver.map(_.text),
      Images          -> Option.when(settings.images.nonEmpty)(settings.images.map(_.text).mkString(" ")),
      DeadlineNs      -> deadline.map(_.toNanos),
      Replay.Fallback -> deadline.map(_ => settings.fallback.label)
    ) ++ plan.policy.toSeq.flatMap: chosen =>
      Seq(
        PolicyName                                          -> Some(chosen.name),
        s"$PolicyName.${PolicyFile.name(chosen.file.role)}" -> Some(chosen.file.text),
        Explore                                             -> chosen.learning.map(_.explore)
      )
    ScenarioSettings.recorded(settings.scenario) ++ NamedScene.recorded(settings.world) ++
      parameters(settings.planning, Some(settings.predictor)) ++
      told.collect { case (name, Some(value)) => ParameterRow(name, value.toString) }

  /** The same of what a flight plans by.
    *
    * @param predictor absent where a recording cannot name it
    */
  def parameters(planning: PlanSettings, predictor: Option[PredictionModel]): Seq[ParameterRow] =
    ParameterRow(Planning, planning.text) +:
      predictor.map(model => ParameterRow(Predictor, PredictionModel.text(model))).toSeq

  /** Reads it back.
    *
    * @return or what is missing, or is not what `skein fly` records
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
      loop  <- AnyLoop.parse(flight.loop)
      link  <- LatencyProfile.parse(flight.link, TextFile.read).left.map(_.message)
      now   <- optional(Predictor, PredictionModel.recordedForms)(PredictionModel.recorded)
      older <- optional(Model, PredictionModel.recordedForms)(PredictionModel.recordedAsModel)
      _     <- Expect.that(loop != LoopKind.Plan || now.orElse(older).isDefined):
        s"the recording has no parameter '$Predictor': by what model was planned is not known"
      moves    <- optional(MovesInFlight, "a number from 1")(_.toIntOption.filter(Moves.mistake(_).isEmpty))
      within   <- optional(DeadlineNs, "nanoseconds")(_.toLongOption.filter(_ > 0))
      fallback <- optional(Replay.Fallback, "hold, repeat, hover or a policy")(Fallback.parse(_).toOption)
      solver   <- optional(SolverSummary.Parameter, "where a solver is")(SolverChoice.parse(_).toOption)
      plant    <- optional(Plant, SimulatedBody.forms)(SimulatedBody.recorded(_).toOption)
      wire     <- optional(Spoken, Wire.values.map(_.label).mkString(" or "))(Wire.parse(_).toOption)
      images   <- optional(Images, "sources of images, with a space between two"): text =>
        val (wrong, sources) = text.split(' ').toList.partitionMap(ImageSource.parse)
        Option.when(wrong.isEmpty)(sources)
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
      chosen  <- policyOf(parameters.get(PolicyName), recording.heading.parametersOf(PolicyName))
      explore <- optional(Explore, "a number")(_.toDoubleOption)
      news    <- newsOf(recording)
      policy = chosen.map(_.copy(learning = explore.map(Learning.Again(_, news))))
    yield RecordedPlan(
      settings.copy(
        predictor = now.orElse(older).getOrElse(settings.predictor),
        movesInFlight = moves.getOrElse(settings.movesInFlight),
        deadline = within.map(Span.ofNanos),
        fallback = fallback.getOrElse(settings.fallback),
        scene = Some(scene),
        images = images.getOrElse(Nil),
        plant = plant.getOrElse(settings.plant),
        wire = wire.getOrElse(settings.wire)
      ),
      FlightPlan(flight.id, loop, link, flight.seed, policy, solver)
    )

  /** Versions' parameters belong to the last that was new before a decision. */
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
            s"its parameter '$Version.$number': expected numbers in Base64, came others"
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
