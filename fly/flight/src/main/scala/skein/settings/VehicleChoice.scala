package skein.settings

import java.nio.file.{Files, Path}
import skein.forward.{
  PlantResponse,
  QuadrotorResponse,
  SensedResponse,
  SpatialResponse,
  SteppedResponse,
  VelocityResponse,
  VelocityResponses
}
import skein.forecast.Structure
import skein.scenario.Scenarios
import skein.mujoco.{MujocoModel, MujocoResponse}
import skein.units.Decimals.fixed
import skein.units.Expect
import skein.vehicle.{Deviation, DrivenCar, Quadrotor, ReducedModel, SensorNoise, TiltModel}

/** Models of vehicles by the names that users give: one list for simulated vehicles (`--plant`) and, for
  * those that can predict, for predictions (`--predictor`, [[PredictionModel]]).
  *
  * @param description one line about the vehicle
  */
final case class VehicleChoice(name: String, description: String, response: VelocityResponse):
  /** Whether an episode costs as much as physics in steps of milliseconds. */
  def fliesInSteps: Boolean = VehicleChoice.isStepped(response)

  def sensedBy(noise: Option[SensorNoise]): VehicleChoice =
    noise.fold(this)(errors => copy(response = SensedResponse(response, errors)))

  /** Why it must not be used at an altitude, m, if so. */
  private[settings] def mistakeAt(altitudeM: Double): Option[String] =
    Option.when(response == VehicleChoice.reduced.response && altitudeM != ReducedModel.IdentifiedAtM):
      s"expected drag, quadrotor or a model file at $altitudeM m altitude: reduced holds at ${ReducedModel.IdentifiedAtM} m"

object VehicleChoice:
  private def isStepped(response: VelocityResponse): Boolean = response match
    case _: (SteppedResponse | QuadrotorResponse) => true
    case SensedResponse(of, _)                    => isStepped(of)
    case _                                        => false

  private val reduced = VehicleChoice(
    "reduced",
    s"reduced model of AirSim's quadrotor at z = −20 m, ${described(ReducedModel.AirSimLag)}",
    PlantResponse(ReducedModel.AirSimLag)
  )

  private def drag(altitudeM: Double) =
    val model = ReducedModel.airSimAt(altitudeM)
    VehicleChoice(
      "drag",
      s"reduced model of AirSim's quadrotor at $altitudeM m altitude, lag " +
        s"${model.lagS.fixed(2)} s, with quadratic drag ${model.dragPerM} /m",
      PlantResponse(model)
    )

  /** Names of the vehicle that performs every action, and of the one that performs velocities. */
  val Spatial = "quadrotor"
  val Tilt    = "tilt"

  private val quadrotor = VehicleChoice(
    Spatial,
    "AirSim's quadrotor with its flight controller at 3 ms",
    VelocityResponses.quadrotor()
  )

  private val tilt = VehicleChoice(
    Tilt,
    "AirSim's quadrotor in space, whose rotors and rotation rates follow at once",
    SpatialResponse(TiltModel.AirSim)
  )

  private val ideal =
    VehicleChoice("ideal", "ideal kinematics: the velocity is the command", VelocityResponses.Ideal)

  private val car = VehicleChoice(
    "car",
    "a car with its driver, by the single-track model with tyre lag",
    PlantResponse(DrivenCar())
  )

  /** The vehicle of this name, without a file.
    *
    * @param altitudeM altitude of its flight
    */
  def named(name: String, altitudeM: Double): Option[VehicleChoice] = all(altitudeM).find(_.name == name)

  private def all(altitudeM: Double) = Vector(reduced, drag(altitudeM), quadrotor, tilt, ideal, car)

  val forms: String =
    s"${all(ReducedModel.IdentifiedAtM).map(_.name).mkString(", ")}, " +
      "quadrotor:DEVIATION or tilt:DEVIATION such as mass=1.3,drag=2,lag=1.5, mujoco:FILE, " +
      "a FILE of ./skein identify, or reduced:FILE"

  private def deviating(text: String, deviation: String)(
      response: Quadrotor => VelocityResponse
  ): Either[String, VehicleChoice] =
    for
      read <- Deviation.parse(deviation)
      _    <- Expect.that(read == Deviation(read.mass, read.drag, read.lag)):
        s"expected mass, drag and lag; wind, gusts, shear and rotors are for fly and spread, got '$text'"
    yield VehicleChoice(
      text,
      s"AirSim's quadrotor with $deviation, which predictive does not know of",
      response(read.quadrotor)
    )

  /** Reads one of the names, or a model file: then the structure that the file says to use, or after
    * `reduced:` the file's model of three parameters, which SIMD supports.
    *
    * @param altitudeM altitude of its flight: the lag of AirSim's vehicles depends on it
    * @return Left says what was expected
    */
  def parse(text: String, altitudeM: Double)(using
      Scenarios
  ): Either[String, VehicleChoice] = named(text, altitudeM) match
    case Some(known) => known.mistakeAt(altitudeM).toLeft(known)
    case None        =>
      text match
        case s"$Spatial:$deviation" => deviating(text, deviation)(VelocityResponses.quadrotor(_))
        case s"$Tilt:$deviation"    =>
          deviating(text, deviation): quadrotor =>
            SpatialResponse(TiltModel.of(quadrotor), Some(tilt.response.predictor))
        case s"mujoco:$path" =>
          MujocoModel.read(Path.of(path)).map(model =>
            VehicleChoice(text, s"MuJoCo's $path in steps of ${model.stepS} s", MujocoResponse(model))
          )
        case s"reduced:$path" =>
          for
            file <- read(path, altitudeM)
            lag  <- file.reduced.toRight(s"$path has no model of three parameters")
          yield ofLag(text, lag, path)
        case path =>
          for file <- read(path, altitudeM)
          yield file.plant match
            case lag: ReducedModel if file.use == Structure.Lag => ofLag(text, lag, path)
            case plant                                          =>
              val kind = if plant.isInstanceOf[ReducedModel] then "reduced model" else "model"
              VehicleChoice(text, s"$kind ${file.use.label} of $path", PlantResponse(plant))

  private def read(path: String, altitudeM: Double)(using Scenarios): Either[String, ModelFile] =
    if Files.isRegularFile(Path.of(path)) then
      for
        file <- ModelFile.read(path)
        _    <- ModelFile.mistake(file.altitudeM, altitudeM).map(mistake => s"$path: $mistake").toLeft(())
      yield file
    else Left(s"expected $forms, got '$path'")

  private def ofLag(text: String, lag: ReducedModel, path: String) =
    VehicleChoice(text, s"reduced model of $path, ${described(lag)}", PlantResponse(lag))

  private def described(lag: ReducedModel) =
    s"gain ${lag.gain}, lag ${lag.lagS} s, dead time ${lag.deadTimeS} s"
