package skein.settings

import java.nio.file.Path
import skein.hil.AutopilotInterface
import skein.mujoco.{MujocoModel, MujocoRotorcraft}
import skein.vehicle.RotorcraftKind

/** What the multirotors of the built-in simulator are, as users name it.
  *
  * @param text `airsim`, or `mujoco:FILE`
  */
final class SimulatedBody private (val text: String, read: => Either[String, Option[MujocoModel]]):
  private lazy val model = read

  def isAirSim: Boolean = this == SimulatedBody.AirSim

  /** For the simulator; None: its own. Or why it cannot be flown here. */
  def kind: Either[String, Option[RotorcraftKind]] = model.map(_.map(MujocoRotorcraft.kind))

  /** Why no autopilot outside flies it. */
  def refusesAutopilots: Option[String] = model match
    case Right(Some(body)) =>
      val steps = AutopilotInterface.Step.toSeconds / body.stepS
      if !body.hasRotors then
        Some(
          s"$text: expected four actuators that each lift, one at " +
            "each corner, for an autopilot's four controls"
        )
      else
        Option.when(steps < 1 || math.abs(steps - steps.round) > 1e-9):
          s"$text: expected a timestep of 1 ms or a whole part of it, at " +
            s"which autopilots' sensors are read, came ${body.stepS} s"
    case _ => None

object SimulatedBody:
  val AirSim: SimulatedBody = SimulatedBody("airsim", Right(None))

  val forms: String = s"${AirSim.text}, or mujoco:FILE"

  /** @return or what was expected, or why the model cannot be flown
    */
  def parse(text: String): Either[String, SimulatedBody] =
    val named = recorded(text)
    named.flatMap(_.model).flatMap(_ => named)

  /** As a recording names it, whose file may be gone. */
  def recorded(text: String): Either[String, SimulatedBody] = text match
    case AirSim.text     => Right(AirSim)
    case s"mujoco:$path" => Right(SimulatedBody(text, MujocoModel.read(Path.of(path)).map(Some(_))))
    case other           => Left(s"expected $forms, came '$other'")
