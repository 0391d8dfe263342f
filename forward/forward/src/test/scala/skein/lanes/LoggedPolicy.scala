package skein.lanes

import java.util.Arrays
import scala.collection.mutable.ArrayBuffer
import skein.lanes.policy.{Directions, LaneObservation, LanePolicy, PolicyLanes}
import skein.policy.Policy

/** Records the inputs and results of many worlds' decisions. */
private[skein] final class LoggedPolicy(of: Policy) extends LanePolicy(PolicyLanes.get(of), true):
  import LoggedPolicy.*
  private val form   = PolicyLanes.get(of)
  private val worlds = LanePolicy.WORLDS

  /** The recorded decisions in order; in each, some world decides. */
  val made: ArrayBuffer[Made] = ArrayBuffer.empty

  /** By world: the indices of its own decisions. */
  private val numbers = Array.fill(worlds)(ArrayBuffer.empty[Int])

  def count(world: Int): Int = numbers(world).size

  /** Index in [[made]] of a world's decision; -1 if there was none. */
  def number(world: Int, decision: Int): Int =
    if decision < numbers(world).size then numbers(world)(decision) else -1

  override def decide(
      observation: LaneObservation,
      own: Directions,
      ownAt: Int,
      known: Directions,
      knownAt: Int,
      into: Directions,
      intoAt: Int
  ): Unit =
    super.decide(observation, own, ownAt, known, knownAt, into, intoAt)
    val read = Vector.tabulate(LaneObservation.READ): what =>
      val (theirs, ours) = (observation.opponent(what), observation.own(what))
      Array.tabulate(worlds): i =>
        theirs(observation.opponentAt(what) + i) - ours(observation.ownAt(what) + i)
    def copied(from: Int, until: Int) =
      Vector.range(from, until).map(i => Arrays.copyOfRange(arrays(i), offsets(i), offsets(i) + worlds))
    made += Made(
      read ++ copied(LaneObservation.READ, form.inputs),
      copied(form.inputs, form.inputs + form.outputs.size)
    )

  override def commit(effort: Array[Float]): Unit =
    super.commit(effort)
    for of <- numbers do of += made.size - 1

  override def rememberBefore(times: Array[Int], before: Int): Unit =
    super.rememberBefore(times, before)
    for world <- 0 until worlds if times(world) < before do numbers(world) += made.size - 1

private[skein] object LoggedPolicy:
  /** Values by input or output of the policy's form, then by world. */
  final case class Made(inputs: Vector[Array[Float]], outputs: Vector[Array[Float]]):
    /** Differences between a world's inputs and these. */
    def off(from: Array[Double], world: Int): Array[Double] =
      from.indices.map(i => math.abs(inputs(i)(world) - from(i))).toArray
