package skein.search

import java.nio.file.{Files, Path}
import skein.experiment.ModelFile
import skein.identify.Structure
import skein.rollout.{Reduced, ReducedResponse, VelocityResponse}
import skein.vehicle.ReducedModel

/** The vehicles of a forward simulation, by the name that users give.
  *
  * @param description
  *   one line that says what flies
  */
final case class VehicleChoice(name: String, description: String, response: VelocityResponse)

object VehicleChoice:

  private val reduced = VehicleChoice(
    "reduced",
    s"reduced model of AirSim's quadrotor at z = −20 m, gain ${Reduced.AirSim.gain}, lag ${Reduced.AirSim.lagS} s, " +
      s"dead time ${Reduced.AirSim.deadTimeS} s",
    Reduced.AirSim
  )

  private def drag(altitudeM: Double) =
    val model = ReducedModel.airSimAt(altitudeM)
    VehicleChoice(
      "drag",
      f"reduced model of AirSim's quadrotor at $altitudeM%s m altitude, lag ${model.lagS}%.2f s, with quadratic drag ${model.dragPerM}%s /m",
      ReducedResponse(model)
    )

  private val quadrotor = VehicleChoice(
    "quadrotor",
    "AirSim's quadrotor with its flight controller at 3 ms",
    VelocityResponse.quadrotor()
  )

  private val ideal =
    VehicleChoice("ideal", "ideal kinematics: the velocity is the command", VelocityResponse.Ideal)

  private def all(altitudeM: Double) = Vector(reduced, drag(altitudeM), quadrotor, ideal)

  val forms: String =
    s"${all(ReducedModel.IdentifiedAtM).map(_.name).mkString(", ")}, a FILE of ./skein identify, or reduced:FILE"

  /** One of the names, or a model file: then what the file says to use, or with `reduced:` before it the file's model of
    * three parameters, which flies by lanes.
    *
    * @param altitudeM
    *   at which it will fly: the lag of AirSim's vehicles depends on it
    * @return
    *   or what was expected
    */
  def parse(text: String, altitudeM: Double): Either[String, VehicleChoice] = all(altitudeM).find(
    _.name == text
  ) match
    case Some(known) =>
      Either.cond(
        known != reduced || altitudeM == ReducedModel.IdentifiedAtM,
        known,
        s"expected drag, quadrotor, ideal or a model file at $altitudeM m altitude: reduced holds at ${ReducedModel.IdentifiedAtM} m"
      )
    case None =>
      text match
        case s"reduced:$path" =>
          for
            file <- read(path, altitudeM)
            lag  <- file.reduced.toRight(s"$path has no model of three parameters")
          yield VehicleChoice(text, described(lag, path), lag)
        case path =>
          for file <- read(path, altitudeM)
          yield
            if file.use == Structure.Lag && file.reduced.isDefined then
              VehicleChoice(text, described(file.reduced.get, path), file.reduced.get)
            else VehicleChoice(text, s"reduced model ${file.use.label} of $path", ReducedResponse(file.model))

  private def read(path: String, altitudeM: Double): Either[String, ModelFile] =
    if Files.isRegularFile(Path.of(path)) then
      for
        file <- ModelFile.read(path)
        _    <- ModelFile.mistake(file.altitudeM, altitudeM).map(mistake => s"$path: $mistake").toLeft(())
      yield file
    else Left(s"expected $forms, came '$path'")

  private def described(model: Reduced, path: String) =
    s"reduced model of $path, gain ${model.gain}, lag ${model.lagS} s, dead time ${model.deadTimeS} s"
