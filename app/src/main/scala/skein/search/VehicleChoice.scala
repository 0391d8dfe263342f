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

  private val drag = VehicleChoice(
    "drag",
    s"reduced model of AirSim's quadrotor with quadratic drag ${ReducedModel.AirSim.dragPerM} /m",
    ReducedResponse(ReducedModel.AirSim)
  )

  private val quadrotor = VehicleChoice(
    "quadrotor",
    "AirSim's quadrotor with its flight controller at 3 ms",
    VelocityResponse.quadrotor()
  )

  private val ideal =
    VehicleChoice("ideal", "ideal kinematics: the velocity is the command", VelocityResponse.Ideal)

  private val all = Vector(reduced, drag, quadrotor, ideal)

  val forms: String = s"${all.map(_.name).mkString(", ")}, a FILE of ./skein identify, or reduced:FILE"

  /** One of the names, or a model file: then what the file says to use, or with `reduced:` before it the file's model of
    * three parameters, which flies by lanes.
    *
    * @return
    *   or what was expected
    */
  def parse(text: String): Either[String, VehicleChoice] = all.find(_.name == text) match
    case Some(known) => Right(known)
    case None        =>
      text match
        case s"reduced:$path" =>
          for
            file <- read(path)
            lag  <- file.reduced.toRight(s"$path has no model of three parameters")
          yield VehicleChoice(text, described(lag, path), lag)
        case path =>
          for file <- read(path)
          yield
            if file.use == Structure.Lag && file.reduced.isDefined then
              VehicleChoice(text, described(file.reduced.get, path), file.reduced.get)
            else VehicleChoice(text, s"reduced model ${file.use.label} of $path", ReducedResponse(file.model))

  private def read(path: String): Either[String, ModelFile] =
    if Files.isRegularFile(Path.of(path)) then ModelFile.read(path)
    else Left(s"expected $forms, came '$path'")

  private def described(model: Reduced, path: String) =
    s"reduced model of $path, gain ${model.gain}, lag ${model.lagS} s, dead time ${model.deadTimeS} s"
