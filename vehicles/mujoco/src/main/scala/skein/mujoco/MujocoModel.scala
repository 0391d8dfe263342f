package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.nio.file.{Files, Path}
import skein.mujoco.MujocoLibrary.calls
import skein.units.Expect

/** A multirotor in MuJoCo's XML. Its body is that of the first joint, a free one; its z is up. The effects of
  * its actuators are measured ([[MujocoMeasuring]]). MuJoCo's memory is freed once the model is unreachable.
  *
  * @param text names it in messages
  */
final class MujocoModel private (
    val text: String,
    compiled: MemorySegment,
    private[mujoco] val body: MujocoBody
):
  def stepS: Double = body.stepS

  /** Whether the model's actuators are exactly four rotors, one at each corner, so that rotors can be
    * controlled directly.
    */
  def hasRotors: Boolean = body.actuators.rotors.isDefined

  /** Allocates `count` simulations; fails only for lack of memory. */
  private[mujoco] def batch(count: Int): MujocoBatch =
    MujocoBatch.of(compiled, count).fold(reason => throw MujocoFailed(s"$text: $reason"), identity)

object MujocoModel:
  /** Reads a model and measures its actuators: some 50 ms.
    *
    * @return Left says why it cannot fly, or that MuJoCo is not installed
    */
  def read(file: Path): Either[String, MujocoModel] =
    for
      _ <- MujocoLibrary.find
      _ <- Expect.that(Files.isRegularFile(file))(s"expected a file of MuJoCo's XML, there is no $file")
      compiled <- load(file)
      body     <- measured(compiled).left.map(reason => s"$file: $reason")
    yield new MujocoModel(file.toString, compiled, body)

  private def measured(compiled: MemorySegment): Either[String, MujocoBody] =
    try MujocoBatch.of(compiled, 1).flatMap(MujocoMeasuring(_).body)
    catch case failed: MujocoFailed => Left(failed.getMessage)

  private[mujoco] def load(file: Path): Either[String, MemorySegment] =
    val arena = Arena.ofAuto()
    val error = arena.allocate(ErrorSize)
    val text  = arena.allocateFrom(file.toString)
    val model = calls.load.invokeExact(text, MemorySegment.NULL, error, ErrorSize.toInt): MemorySegment
    Either.cond(
      model.address != 0,
      NativeMemory.owned(model, arena)(calls.deleteModel.invokeExact(_): Unit),
      s"$file: ${error.getString(0).trim}"
    )

  private val ErrorSize = 1000L
