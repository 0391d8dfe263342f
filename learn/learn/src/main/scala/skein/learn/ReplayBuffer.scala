package skein.learn

import java.io.{DataInput, DataOutput, IOException}
import skein.signal.SplitMix64
import skein.units.eachBelow

/** The newest transitions, from which batches are drawn. */
final class ReplayBuffer(observations: Int, actions: Int, capacity: Int) extends Saved:
  private val all  = Transitions(observations, actions, capacity)
  private var next = 0
  private var held = 0

  def size: Int = held

  /** Adds transitions, each from a row of each array. */
  def add(
      seen: Array[Float],
      chosen: Array[Float],
      reached: Array[Float],
      rewards: Array[Float],
      terminated: Array[Boolean]
  ): Unit =
    eachBelow(rewards.length): row =>
      System.arraycopy(seen, row * observations, all.seen, next * observations, observations)
      System.arraycopy(chosen, row * actions, all.actions, next * actions, actions)
      System.arraycopy(reached, row * observations, all.reached, next * observations, observations)
      all.rewards(next) = rewards(row)
      all.goesOn(next) = if terminated(row) then 0 else 1
      next = if next + 1 == capacity then 0 else next + 1
      held = (held + 1).min(capacity)

  /** Draws transitions uniformly, with replacement. */
  def draw(into: Transitions, random: SplitMix64): Unit =
    eachBelow(into.count): row =>
      val from = random.nextInt(held)
      System.arraycopy(all.seen, from * observations, into.seen, row * observations, observations)
      System.arraycopy(all.actions, from * actions, into.actions, row * actions, actions)
      System.arraycopy(all.reached, from * observations, into.reached, row * observations, observations)
      into.rewards(row) = all.rewards(from)
      into.goesOn(row) = all.goesOn(from)

  def save(out: DataOutput): Unit =
    out.writeInt(next)
    out.writeInt(held)
    Saved.write(out, all.seen, held * observations)
    Saved.write(out, all.actions, held * actions)
    Saved.write(out, all.reached, held * observations)
    Saved.write(out, all.rewards, held)
    Saved.write(out, all.goesOn, held)

  def load(in: DataInput): Unit =
    next = in.readInt()
    held = in.readInt()
    if next < 0 || next >= capacity || held < 0 || held > capacity then
      throw IOException(s"expected a replay buffer of at most $capacity transitions, got $held")
    for part <- Seq(all.seen, all.actions, all.reached, all.rewards, all.goesOn) do
      Saved.readSome(in, part): Unit

/** Rows of observations, actions, rewards and reached observations.
  *
  * @param goesOn 1 if the episode continued, 0 if it terminated
  */
final class Transitions(observations: Int, acted: Int, val count: Int):
  val seen: Array[Float]    = Array.ofDim(count * observations)
  val actions: Array[Float] = Array.ofDim(count * acted)
  val reached: Array[Float] = Array.ofDim(count * observations)
  val rewards: Array[Float] = Array.ofDim(count)
  val goesOn: Array[Float]  = Array.ofDim(count)
