package skein.settings

import java.nio.file.Path
import skein.hil.AutopilotInterface
import skein.mujoco.{MujocoModel, MujocoRotorcraft}
import skein.vehicle.{Deviation, RotorcraftKind}

/** The bodies of the built-in simulator's multirotors, as users name them.
  *
  * @param text `airsim`, `airsim:` and its deviations, or `mujoco:FILE`
  */
final class SimulatedBody private (
    val text: String,
    read: => Either[String, Option[MujocoModel]],
    deviation: Option[Deviation] = None
):
  private lazy val model = read

  def isAirSim: Boolean = this == SimulatedBody.AirSim

  /** The kind for the simulator; None means its own. Left says why it cannot be simulated here.
    *
    * @param seed seed of the gusts
    */
  def kind(seed: Long): Either[String, Option[RotorcraftKind]] =
    model.map(_.map(MujocoRotorcraft.kind).orElse(deviation.map(_.kind(seed))))

  /** Why external autopilots cannot fly it, if so. */
  def refusesAutopilots: Option[String] = model match
    case _ if deviation.isDefined =>
      Some(s"$text: expected airsim or mujoco:FILE, whose physics has steps of whole milliseconds")
    case Right(Some(body)) =>
      if !body.hasRotors then
        Some(
          s"$text: expected four actuators that each lift, one at " +
            "each corner, for an autopilot's four controls"
        )
      else
        Option.when(!SimulatedBody.meetsSensors(body.stepS)):
          s"$text: expected a timestep of 1 ms or a whole part of it, at " +
            s"which autopilots' sensors are read, got ${body.stepS} s"
    case _ => None

object SimulatedBody:
  val AirSim: SimulatedBody = SimulatedBody("airsim", Right(None))

  val forms: String = s"${AirSim.text}, airsim:DEVIATION, or mujoco:FILE"

  /** Whether each reading of the autopilots' sensors falls on the end of a step. */
  private[settings] def meetsSensors(stepS: Double): Boolean =
    val steps = AutopilotInterface.Step.toSeconds / stepS
    steps >= 1 && math.abs(steps - steps.round) <= 1e-9

  /** Reads the user's text; Left says what was expected, or why the model cannot be simulated. */
  def parse(text: String): Either[String, SimulatedBody] =
    val named = recorded(text)
    named.flatMap(_.model).flatMap(_ => named)

  /** Reads a recording's text, whose file may be gone. */
  def recorded(text: String): Either[String, SimulatedBody] = text match
    case AirSim.text          => Right(AirSim)
    case s"airsim:$deviation" =>
      Deviation.parse(deviation).map(read => SimulatedBody(text, Right(None), Some(read)))
    case s"mujoco:$path" => Right(SimulatedBody(text, MujocoModel.read(Path.of(path)).map(Some(_))))
    case other           => Left(s"expected $forms, got '$other'")
