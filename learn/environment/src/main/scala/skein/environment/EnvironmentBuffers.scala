package skein.environment

import java.nio.{ByteBuffer, ByteOrder, FloatBuffer}
import skein.policy.LearnerSpace
import skein.units.eachBelow

/** The memory that an environment batch shares with its caller: one block, in the machine's byte order. It
  * contains the following arrays one after the other, for A learners in the scenario's order and n
  * environments; observations have F components and actions K ([[LearnerSpace]]):
  *
  * | what                                                                | type | shape   |
  * |:--------------------------------------------------------------------|:-----|:--------|
  * | actions, −1 to 1                                                    | f32  | A, K, n |
  * | observations                                                        | f32  | A, F, n |
  * | last observations of episodes that ended, under same-step autoreset | f32  | A, F, n |
  * | rewards                                                             | f32  | A, n    |
  * | distance to the nearest opponent at the last score, m               | f32  | A, n    |
  * | time since the episode's beginning, s                               | f32  | n       |
  * | terminated                                                          | u8   | n       |
  * | truncated                                                           | u8   | n       |
  * | whether the learner decides now                                     | u8   | A, n    |
  */
final class EnvironmentBuffers(
    block: ByteBuffer,
    val agents: Int,
    val count: Int,
    val space: LearnerSpace = LearnerSpace.Level
):
  locally:
    val bytes = EnvironmentBuffers.bytes(agents, count, space)
    require(block.capacity == bytes, s"expected a block of $bytes bytes, got ${block.capacity}")

  private var at = 0

  private def part(bytes: Int): ByteBuffer =
    val slice = block.slice(at, bytes).order(ByteOrder.nativeOrder)
    at += bytes
    slice

  val actions: FloatBuffer      = part(4 * agents * space.outputs * count).asFloatBuffer
  val observations: FloatBuffer = part(4 * agents * space.inputs * count).asFloatBuffer
  val finals: FloatBuffer       = part(4 * agents * space.inputs * count).asFloatBuffer
  val rewards: FloatBuffer      = part(4 * agents * count).asFloatBuffer
  val distances: FloatBuffer    = part(4 * agents * count).asFloatBuffer
  private val times             = part(4 * count).asFloatBuffer
  val terminations: ByteBuffer  = part(count)
  val truncations: ByteBuffer   = part(count)
  private val dues              = part(agents * count)

  def action(agent: Int, number: Int): Float              = actions.get(agent * count + number)
  def reward(agent: Int, number: Int, value: Float): Unit = rewards.put(agent * count + number, value): Unit

  /** Writes a part of a row: environments from `first` on, `stride` apart. */
  private[environment] def write(
      to: FloatBuffer,
      row: Int,
      first: Int,
      stride: Int,
      from: Array[Float],
      at: Int,
      some: Int
  ): Unit =
    val place = row * count + first
    if stride == 1 then to.put(place, from, at, some): Unit
    else
      eachBelow(some): i =>
        to.put(place + i * stride, from(at + i)): Unit

  /** Writes whether a learner decides now, in environments from `first` on, `stride` apart. */
  private[environment] def due(agent: Int, first: Int, stride: Int, some: Int, value: Boolean): Unit =
    eachBelow(some): i =>
      dues.put(agent * count + first + i * stride, byte(value)): Unit

  /** Reads a part of a row: environments from `first` on, `stride` apart. */
  private[environment] def read(
      from: FloatBuffer,
      row: Int,
      first: Int,
      stride: Int,
      into: Array[Float],
      some: Int
  ): Unit =
    val place = row * count + first
    if stride == 1 then from.get(place, into, 0, some): Unit
    else
      eachBelow(some): i =>
        into(i) = from.get(place + i * stride)

  /** Writes a learner's and its environment's state at the start of an episode, except its observation. */
  def begun(agent: Int, number: Int, distanceM: Float): Unit =
    distance(agent, number, distanceM)
    reward(agent, number, 0)
    time(number, 0)
    terminated(number, false)
    truncated(number, false)

  def distance(agent: Int, number: Int, metres: Float): Unit =
    distances.put(agent * count + number, metres): Unit
  def time(number: Int, seconds: Float): Unit       = times.put(number, seconds): Unit
  def terminated(number: Int, value: Boolean): Unit = terminations.put(number, byte(value)): Unit
  def truncated(number: Int, value: Boolean): Unit  = truncations.put(number, byte(value)): Unit
  private def byte(value: Boolean): Byte            = if value then 1 else 0

object EnvironmentBuffers:
  def bytes(agents: Int, count: Int, space: LearnerSpace = LearnerSpace.Level): Int =
    val floats = agents * (space.outputs + 2 * space.inputs + 2) + 1
    Math.toIntExact((4L * floats + 2 + agents) * count)
