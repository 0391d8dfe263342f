package skein.learn

import skein.signal.SplitMix64

/** Tasks whose best policies are known. */
private[learn] abstract class SmallTask(val count: Int, val observations: Int, seed: Long) extends Task:
  val actions                           = 1
  val seen, reached: Array[Float]       = Array.ofDim(count * observations)
  val rewards: Array[Float]             = Array.ofDim(count)
  val terminated, ended: Array[Boolean] = Array.ofDim(count)
  protected var random: SplitMix64      = SplitMix64(seed)

  def begin(round: Long, actor: Network): Unit =
    random = SplitMix64(SplitMix64.seedOf(seed, round))
    for row <- 0 until count do start(row)

  protected def start(row: Int): Unit
  protected def drawn(): Float = (2 * random.nextDouble() - 1).toFloat

/** One step: the best action is half of the observation; every episode terminates immediately. */
private[learn] final class HalfOfIt(count: Int, seed: Long) extends SmallTask(count, 1, seed):
  protected def start(row: Int): Unit = seen(row) = drawn()

  def step(chosen: Array[Float]): Unit =
    for row <- 0 until count do
      val off = chosen(row).max(-1f).min(1f) - 0.5f * seen(row)
      rewards(row) = -off * off
      terminated(row) = true
      ended(row) = true
      reached(row) = seen(row)
      start(row)

/** An integrator to be controlled to 0, in episodes of 20 steps that are truncated: x += 0.2 a. */
private[learn] final class Integrator(count: Int, seed: Long) extends SmallTask(count, 1, seed):
  private val steps = Array.ofDim[Int](count)

  protected def start(row: Int): Unit =
    seen(row) = drawn()
    steps(row) = 0

  def step(chosen: Array[Float]): Unit =
    for row <- 0 until count do
      val next = seen(row) + 0.2f * chosen(row).max(-1f).min(1f)
      rewards(row) = -next * next
      reached(row) = next
      steps(row) += 1
      ended(row) = steps(row) == 20
      seen(row) = next
      if ended(row) then start(row)
