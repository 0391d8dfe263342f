package skein.settings

import skein.identify.Structure
import skein.vehicle.*

/** By which model `predictive` carries the readings of a vehicle forward. */
enum PredictionModel:
  /** One of [[VehicleChoice]]'s, as it flies at the altitude of a vehicle. */
  case Named(name: String)

  /** A first-order response, identified from flights.
    *
    * @param flownAtM
    *   the altitude of these flights, where it is known: no other is flown by it, since AirSim's lag depends on it
    */
  case Fitted(model: ReducedModel, flownAtM: Option[Double] = None)

  /** Straight on, whatever was commanded. */
  case ConstantVelocity

  /** Along an arc, whatever was commanded. */
  case ConstantTurn

  /** Of a vehicle that keeps an altitude. */
  def at(altitudeM: Double): VehicleModel[?] = this match
    case Named(name)      => VehicleChoice.named(name, altitudeM).get.response.predictor
    case Fitted(model, _) => ReducedVehicleModel(model)
    case ConstantVelocity => skein.vehicle.ConstantVelocity
    case ConstantTurn     => skein.vehicle.ConstantTurn

object PredictionModel:
  val Quadrotor: PredictionModel = Named("quadrotor")

  /** Of three parameters, at the altitude where it was identified. */
  val AirSimReduced: PredictionModel = Named("reduced")

  /** With drag, and the lag of the altitude. */
  val AirSimDrag: PredictionModel = Named("drag")

  private val named = Vector(
    "reduced"           -> AirSimReduced,
    "drag"              -> AirSimDrag,
    "quadrotor"         -> Quadrotor,
    "constant-velocity" -> ConstantVelocity,
    "constant-turn"     -> ConstantTurn
  )

  val forms: String =
    s"${named.map(_._1).mkString(", ")}, a FILE of ./skein identify, " +
      "or reduced:FILE for its model of three parameters"

  /** A name, or a model file of `skein identify`. */
  def parse(text: String): Either[String, PredictionModel] =
    named.collectFirst { case (`text`, model) => model } match
      case Some(model) => Right(model)
      case None        =>
        val (path, of) = text match
          case s"reduced:$path" =>
            (
              path,
              (file: ModelFile) =>
                file.models.get(Structure.Lag).toRight(s"$path has no model of three parameters")
            )
          case path => (path, (file: ModelFile) => Right(file.model))
        (for
          file  <- ModelFile.read(path)
          model <- of(file)
        yield Fitted(model, file.altitudeM)).left.map(reason => s"expected $forms: $reason")

  /** What is wrong with predicting vehicles of an altitude by it, if anything. */
  def mistake(model: PredictionModel, altitudeM: Double): Option[String] = model match
    case Named(name)         => VehicleChoice.parse(name, altitudeM).left.toOption
    case Fitted(_, flownAtM) => ModelFile.mistake(flownAtM, altitudeM)
    case _                   => None

  /** As a recording keeps it: [[recorded]] reads it back. A double's shortest text reads back as the same double. */
  def text(model: PredictionModel): String = model match
    case Fitted(model, _) =>
      Seq(model.gain, model.lagS, model.deadTimeS, model.turnLagS, model.dragPerM).mkString(" ")
    case other => named.collectFirst { case (name, `other`) => name }.get

  def recorded(text: String): Option[PredictionModel] =
    named.collectFirst { case (`text`, model) => model }.orElse:
      text.split(' ').map(_.toDoubleOption) match
        case Array(Some(gain), Some(lag), Some(deadTime), Some(turnLag), Some(drag)) =>
          scala.util.Try(Fitted(ReducedModel(gain, lag, deadTime, turnLag, drag))).toOption
        case _ => None

  /** As recordings of older versions keep it, whose `reduced` has drag. */
  def recordedAsModel(text: String): Option[PredictionModel] =
    if text == "reduced" then Some(AirSimDrag) else recorded(text)
