package skein.environment

import java.nio.{ByteBuffer, ByteOrder, FloatBuffer}
import skein.lanes.LearnerPolicy.Fields

/** What an environment batch shares with who steps it: one block of memory, in the machine's byte order. Of A
  * learners, in the scenario's order, and n environments, one after the other:
  *
  * | what                                                                | type | shape   |
  * |:--------------------------------------------------------------------|:-----|:--------|
  * | actions, −1 to 1                                                    | f32  | A, n    |
  * | observations                                                        | f32  | A, 9, n |
  * | last observations of episodes that ended, under same-step autoreset | f32  | A, 9, n |
  * | rewards                                                             | f32  | A, n    |
  * | distance to the nearest opponent at the last score, m               | f32  | A, n    |
  * | time since the episode's beginning, s                               | f32  | n       |
  * | terminated                                                          | u8   | n       |
  * | truncated                                                           | u8   | n       |
  * | whether the learner decides now                                     | u8   | A, n    |
  */
final class EnvironmentBuffers(block: ByteBuffer, val agents: Int, val count: Int):
  require(
    block.capacity == EnvironmentBuffers.bytes(agents, count),
    s"expected a block of ${EnvironmentBuffers.bytes(agents, count)} bytes, came ${block.capacity}"
  )

  private var at = 0

  private def part(bytes: Int): ByteBuffer =
    val slice = block.slice(at, bytes).order(ByteOrder.nativeOrder)
    at += bytes
    slice

  val actions: FloatBuffer      = part(4 * agents * count).asFloatBuffer
  val observations: FloatBuffer = part(4 * agents * Fields * count).asFloatBuffer
  val finals: FloatBuffer       = part(4 * agents * Fields * count).asFloatBuffer
  val rewards: FloatBuffer      = part(4 * agents * count).asFloatBuffer
  val distances: FloatBuffer    = part(4 * agents * count).asFloatBuffer
  private val times             = part(4 * count).asFloatBuffer
  val terminations: ByteBuffer  = part(count)
  val truncations: ByteBuffer   = part(count)
  private val dues              = part(agents * count)

  def action(agent: Int, number: Int): Float              = actions.get(agent * count + number)
  def reward(agent: Int, number: Int, value: Float): Unit = rewards.put(agent * count + number, value): Unit

  /** Writes a learner's and its environment's state at the begin of an episode, except its observation. */
  def begun(agent: Int, number: Int, distanceM: Float): Unit =
    distance(agent, number, distanceM)
    reward(agent, number, 0)
    time(number, 0)
    terminated(number, false)
    truncated(number, false)

  def distance(agent: Int, number: Int, metres: Float): Unit =
    distances.put(agent * count + number, metres): Unit
  def time(number: Int, seconds: Float): Unit            = times.put(number, seconds): Unit
  def terminated(number: Int, value: Boolean): Unit      = terminations.put(number, byte(value)): Unit
  def truncated(number: Int, value: Boolean): Unit       = truncations.put(number, byte(value)): Unit
  def due(agent: Int, number: Int, value: Boolean): Unit = dues.put(agent * count + number, byte(value)): Unit
  private def byte(value: Boolean): Byte                 = if value then 1 else 0

object EnvironmentBuffers:
  def bytes(agents: Int, count: Int): Int =
    Math.toIntExact((4L * (3 * agents + 2 * agents * Fields + 1) + 2 + agents) * count)
