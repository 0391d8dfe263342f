package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.nio.file.{Files, Path}
import skein.mujoco.MujocoBatch.Part

/** A multirotor in MuJoCo's XML. Its body is the one of the first joint, a free one; its z is up. What its actuators do is
  * measured ([[MujocoMeasuring]]). MuJoCo's memory of it is freed when nobody refers to it any more.
  *
  * @param text
  *   names it in messages
  * @param stepS
  *   of a step, s
  * @param place
  *   where a row has the body's position and attitude; likewise the next ones
  * @param standsAtM
  *   the body's height in the model, m: where it stands on the ground
  * @param hoveringRow
  *   of one that has long hovered
  * @param standingRow
  *   of one that stands
  */
final class MujocoModel private[mujoco] (
    val text: String,
    val stepS: Double,
    private[mujoco] val compiled: MemorySegment,
    private[mujoco] val place: Part,
    private[mujoco] val velocity: Part,
    private[mujoco] val controls: Part,
    private[mujoco] val time: Part,
    private[mujoco] val standsAtM: Double,
    private[mujoco] val actuators: MujocoActuators,
    private[mujoco] val hoveringRow: Array[Double],
    private[mujoco] val standingRow: Array[Double]
):
  /** Whether its actuators are four rotors, one at each corner, which can be told their controls one by one. */
  def hasRotors: Boolean = actuators.rotors.isDefined

  /** So many simulations of it. A model of which there was one has more, but for want of memory. */
  private[mujoco] def batch(count: Int): MujocoBatch =
    MujocoBatch.of(compiled, count).fold(reason => throw MujocoFailed(s"$text: $reason"), identity)

object MujocoModel:
  /** Reads a model and measures its actuators: some 50 ms.
    *
    * @return
    *   or why it cannot be flown, or that MuJoCo is not here
    */
  def read(file: Path): Either[String, MujocoModel] =
    for
      _ <- MujocoLibrary.find
      _ <- Either.cond(Files.isRegularFile(file), (), s"expected a file of MuJoCo's XML, there is no $file")
      compiled <- load(file)
      model    <- measured(file, compiled).left.map(reason => s"$file: $reason")
    yield model

  private def measured(file: Path, compiled: MemorySegment): Either[String, MujocoModel] =
    try MujocoBatch.of(compiled, 1).flatMap(MujocoMeasuring(file.toString, compiled, _).model)
    catch case failed: MujocoFailed => Left(failed.getMessage)

  private[mujoco] def load(file: Path): Either[String, MemorySegment] =
    val arena = Arena.ofAuto()
    val error = arena.allocate(ErrorSize)
    val model = MujocoCalls.load(arena.allocateFrom(file.toString), error, ErrorSize.toInt)
    Either.cond(
      model.address != 0,
      NativeMemory.owned(model, arena)(MujocoCalls.deleteModel(_)),
      s"$file: ${error.getString(0).trim}"
    )

  private val ErrorSize = 1000L
