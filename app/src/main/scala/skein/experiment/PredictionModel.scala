package skein.experiment

import skein.vehicle.*

/** By which model `predictive` carries the readings of a vehicle forward. */
enum PredictionModel:
  /** AirSim's vehicle with its flight controller. */
  case Quadrotor

  /** [[skein.vehicle.ReducedModel.airSimAt]] the altitude at which a vehicle flies. */
  case AirSimReduced

  /** A first-order response, identified from flights.
    *
    * @param flownAtM
    *   the altitude of these flights, where it is known: no other is flown by it, since AirSim's lag depends on it
    */
  case Reduced(model: ReducedModel, flownAtM: Option[Double] = None)

  /** Straight on, whatever was commanded. */
  case ConstantVelocity

  /** Along an arc, whatever was commanded. */
  case ConstantTurn

  /** Of a vehicle that keeps an altitude. */
  def at(altitudeM: Double): VehicleModel[?] = this match
    case Quadrotor         => QuadrotorModel.AirSim
    case AirSimReduced     => ReducedVehicleModel(ReducedModel.airSimAt(altitudeM))
    case Reduced(model, _) => ReducedVehicleModel(model)
    case ConstantVelocity  => skein.vehicle.ConstantVelocity
    case ConstantTurn      => skein.vehicle.ConstantTurn

object PredictionModel:
  private val named = Vector(
    "quadrotor"         -> Quadrotor,
    "reduced"           -> AirSimReduced,
    "constant-velocity" -> ConstantVelocity,
    "constant-turn"     -> ConstantTurn
  )

  /** A name, or the path of a model file of `skein identify`. */
  def parse(text: String): Either[String, PredictionModel] =
    named.collectFirst { case (`text`, model) => model } match
      case Some(model) => Right(model)
      case None        =>
        ModelFile
          .read(text)
          .map(file => Reduced(file.model, file.altitudeM))
          .left
          .map(reason => s"expected ${named.map(_._1).mkString(", ")} or a model file: $reason")

  /** As a recording keeps it: [[recorded]] reads it back. A double's shortest text reads back as the same double. */
  def text(model: PredictionModel): String = model match
    case Reduced(model, _) =>
      Seq(model.gain, model.lagS, model.deadTimeS, model.turnLagS, model.dragPerM).mkString(" ")
    case other => named.collectFirst { case (name, `other`) => name }.get

  def recorded(text: String): Option[PredictionModel] =
    named.collectFirst { case (`text`, model) => model }.orElse:
      text.split(' ').map(_.toDoubleOption) match
        case Array(Some(gain), Some(lag), Some(deadTime), Some(turnLag), Some(drag)) =>
          scala.util.Try(Reduced(ReducedModel(gain, lag, deadTime, turnLag, drag))).toOption
        case _ => None
