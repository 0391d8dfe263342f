package skein.settings

import skein.forecast.Structure
import skein.policy.Agent
import skein.scenario.Scenarios
import scala.util.Try
import skein.vehicle.*

/** The model by which `predictive` predicts a vehicle from its readings. */
enum PredictionModel:
  /** A model of [[VehicleChoice]], at the altitude of a vehicle. */
  case Named(name: String)

  /** A first-order response, identified from flights.
    *
    * @param flownAtM the altitude of these flights, if known: the model is not used at other altitudes, since
    *   AirSim's lag depends on the altitude
    */
  case Fitted(model: ReducedModel, flownAtM: Option[Double] = None)

  /** A plant of a program's own structure, identified from flights.
    *
    * @param values the parameters' values
    */
  case Own(structure: Structure, values: Vector[Double])

  case ConstantVelocity

  case ConstantTurn

  /** The whole quadrotor, with a correction of its errors that is learned in flight. */
  case Adaptive

  def at(altitudeM: Double): VehicleModel[?] = this match
    case Named(name)            => VehicleChoice.named(name, altitudeM).get.response.predictor
    case Fitted(model, _)       => PlantModel(model)
    case Own(structure, values) => PlantModel(structure.plant(values))
    case ConstantVelocity       => skein.vehicle.ConstantVelocity
    case ConstantTurn           => skein.vehicle.ConstantTurn
    case Adaptive               => AdaptiveQuadrotor

  def forAgent(agent: Agent): VehicleModel[?] = agent.kind match
    case VehicleKind.Multirotor => at(-agent.startPositionNed.z)
    case VehicleKind.Car        => CarModel()

object PredictionModel:
  val Quadrotor: PredictionModel = Named("quadrotor")

  /** The model with three parameters, at the altitude where it was identified. */
  val AirSimReduced: PredictionModel = Named("reduced")

  /** The model with drag, and the altitude's lag. */
  val AirSimDrag: PredictionModel = Named("drag")

  private val named = Vector(
    "reduced"           -> AirSimReduced,
    "drag"              -> AirSimDrag,
    "quadrotor"         -> Quadrotor,
    "constant-velocity" -> ConstantVelocity,
    "constant-turn"     -> ConstantTurn,
    "adaptive"          -> Adaptive
  )

  val forms: String =
    s"${named.map(_._1).mkString(", ")}, a FILE of ./skein identify, " +
      "or reduced:FILE for its model of three parameters"

  /** Reads a name, or a model file of `skein identify`. */
  def parse(text: String)(using Scenarios): Either[String, PredictionModel] =
    named.collectFirst { case (`text`, model) => model } match
      case Some(model) => Right(model)
      case None        =>
        val model = text match
          case s"reduced:$path" =>
            for
              file <- ModelFile.read(path)
              lag  <- file.reduced.toRight(s"$path has no model of three parameters")
            yield Fitted(lag, file.altitudeM)
          case path => ModelFile.read(path).map(of)
        model.left.map(reason => s"expected $forms: $reason")

  private[skein] def of(file: ModelFile): PredictionModel = file.plant match
    case model: ReducedModel => Fitted(model, file.altitudeM)
    case _                   => Own(file.use, file.models(file.use))

  /** Why it must not predict vehicles at an altitude, if so. */
  def mistake(model: PredictionModel, altitudeM: Double): Option[String] = model match
    case Named(name)         => VehicleChoice.named(name, altitudeM).flatMap(_.mistakeAt(altitudeM))
    case Fitted(_, flownAtM) => ModelFile.mistake(flownAtM, altitudeM)
    case _                   => None

  /** The text in a recording, which [[recorded]] reads back. A double's shortest text is read back as an
    * equal double.
    */
  def text(model: PredictionModel): String = model match
    case Fitted(model, _) =>
      Seq(model.gain, model.lagS, model.deadTimeS, model.turnLagS, model.dragPerM).mkString(" ")
    case Own(structure, values) => (structure.label +: values).mkString(" ")
    case other                  => named.collectFirst { case (name, `other`) => name }.get

  private[settings] def recordedForms(using scenarios: Scenarios): String =
    val own = scenarios.ownStructures.map(_.label)
    s"a model's name or five numbers${
        if own.isEmpty then "" else own.mkString(", or values behind ", " or ", "")
      }"

  def recorded(text: String)(using scenarios: Scenarios): Option[PredictionModel] =
    named.collectFirst { case (`text`, model) => model }.orElse:
      val words   = text.split(' ').toVector
      val own     = scenarios.ownStructures.find(_.label == words.head)
      val numbers = (if own.isDefined then words.tail else words).flatMap(_.toDoubleOption)
      val model   = own match
        case Some(structure) => Try { structure.plant(numbers): Unit; Own(structure, numbers) }
        case None            => Try:
            val Vector(gain, lag, deadTime, turnLag, drag) = numbers: @unchecked
            Fitted(ReducedModel(gain, lag, deadTime, turnLag, drag))
      model.toOption

  /** Reads recordings of older versions, whose `reduced` has drag. */
  def recordedAsModel(text: String)(using Scenarios): Option[PredictionModel] =
    if text == "reduced" then Some(AirSimDrag) else recorded(text)
