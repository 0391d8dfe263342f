package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.nio.file.{Files, Path}
import skein.units.Expect

/** A multirotor in MuJoCo's XML. Its body is the one of the first joint, a free one; its z is up. What its
  * actuators do is measured ([[MujocoMeasuring]]). MuJoCo's memory of it is freed when nobody refers to it
  * any more.
  *
  * @param text names it in messages
  */
final class MujocoModel private (
    val text: String,
    compiled: MemorySegment,
    private[mujoco] val body: MujocoBody
):
  /** Of a step, s. */
  def stepS: Double = body.stepS

  /** Whether its actuators are four rotors, one at each corner, which can be told their controls one by one.
    */
  def hasRotors: Boolean = body.actuators.rotors.isDefined

  /** So many simulations of it. A model of which there was one has more, but for want of memory. */
  private[mujoco] def batch(count: Int): MujocoBatch =
    MujocoBatch.of(compiled, count).fold(reason => throw MujocoFailed(s"$text: $reason"), identity)

object MujocoModel:
  /** Reads a model and measures its actuators: some 50 ms.
    *
    * @return or why it cannot be flown, or that MuJoCo is not here
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
    val model = MujocoCalls.load(arena.allocateFrom(file.toString), error, ErrorSize.toInt)
    Either.cond(
      model.address != 0,
      NativeMemory.owned(model, arena)(MujocoCalls.deleteModel(_)),
      s"$file: ${error.getString(0).trim}"
    )

  private val ErrorSize = 1000L
