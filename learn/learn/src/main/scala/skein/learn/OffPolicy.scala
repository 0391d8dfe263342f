package skein.learn

import java.io.{DataInput, DataOutput}
import skein.signal.SplitMix64

/** Common part of replay learners: they remember transitions, and after each step make updates with batches
  * of them.
  */
private[learn] abstract class OffPolicy(
    observations: Int,
    actions: Int,
    settings: LearnerSettings,
    seed: Long
) extends Learner:
  protected val initial: SplitMix64       = SplitMix64(SplitMix64.seedOf(seed, -1))
  protected var random: SplitMix64        = SplitMix64(seed)
  protected val rows: Int                 = settings.batch
  private[learn] val replay: ReplayBuffer = ReplayBuffer(observations, actions, settings.replay)
  private[learn] val batch: Transitions   = Transitions(observations, actions, rows)
  private var steps                       = 0L
  private var updates                     = 0L
  private var deciding                    = Pass(Vector(1, 1), 1)

  /** All learned parts, in a fixed order for saving. */
  protected def learned: Vector[Saved]

  /** One action drawn from the actor's row of outputs, with exploration. */
  protected def tried(outputs: Array[Float], at: Int, action: Int): Float

  /** Makes one update from the current [[batch]]. */
  private[learn] def update(): Unit

  def begin(round: Long): Unit = random = SplitMix64(SplitMix64.seedOf(seed, round))

  def explore(seen: Array[Float], into: Array[Float]): Unit =
    val count = seen.length / observations
    if steps < settings.randomSteps then
      for i <- 0 until count * actions do into(i) = (2 * random.nextDouble() - 1).toFloat
    else
      if deciding.rows != count then deciding = Pass(actor.widths, count)
      System.arraycopy(seen, 0, deciding.input, 0, seen.length)
      deciding.forward(actor, 0, count)
      for row <- 0 until count; action <- 0 until actions do
        into(row * actions + action) = tried(deciding.output, row * actor.outputs, action)

  def learn(seen: Array[Float], chosen: Array[Float], task: Task): Unit =
    replay.add(seen, chosen, task.reached, task.rewards, task.terminated)
    steps += task.count
    if steps >= settings.randomSteps && replay.size >= rows then
      val due = ((steps - settings.randomSteps) * settings.updatesPerStep).toLong
      while updates < due do
        replay.draw(batch, random)
        update()
        updates += 1

  def save(out: DataOutput): Unit =
    out.writeLong(steps)
    out.writeLong(updates)
    learned.foreach(_.save(out))
    replay.save(out)

  def load(in: DataInput): Unit =
    steps = in.readLong()
    updates = in.readLong()
    learned.foreach(_.load(in))
    replay.load(in)
