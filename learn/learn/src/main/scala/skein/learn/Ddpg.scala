package skein.learn

import skein.units.eachFrom

/** Deep deterministic policy gradient: one critic, a policy that ascends its gradient, slow copies of both;
  * it explores with normal noise. Source: Lillicrap, Hunt, Pritzel, Heess, Erez, Tassa, Silver, Wierstra,
  * "Continuous control with deep reinforcement learning", arXiv:1509.02971; the noise has no memory, as in
  * Fujimoto, van Hoof, Meger, arXiv:1802.09477.
  */
final class Ddpg(
    observations: Int,
    actions: Int,
    settings: LearnerSettings,
    seed: Long,
    workers: BatchThreads
) extends OffPolicy(observations, actions, settings, seed):
  import Ddpg.*

  private val widths        = observations +: settings.hidden :+ actions
  val actor: Network        = Network(widths).draw(initial, LastScale)
  private[learn] val target = Network(widths)
  target.take(actor)
  private val optimiser      = Adam(actor.parameters.length, settings.rate)
  private[learn] val critics = Critics(1, observations, actions, settings, initial)
  private val pass           = Pass(widths, rows)
  private val gradient       = Gradient(actor.parameters.length, rows)
  private val chosen         = Array.ofDim[Float](rows * actions)
  private val slopes         = Array.ofDim[Float](rows * actions)
  private val wanted         = Array.ofDim[Float](rows)

  protected def learned: Vector[Saved] = Vector(actor, target, optimiser, critics)

  def isFinite: Boolean = actor.isFinite && critics.isFinite

  protected def tried(outputs: Array[Float], at: Int, action: Int): Float =
    (StrictMath.tanh(outputs(at + action)) + Deviation * Noise.normal(random)).max(-1.0).min(1.0).toFloat

  private[learn] def update(): Unit =
    critics.clear()
    workers.share(rows): (part, from, until) =>
      choose(target, batch.reached, from, until)
      critics.valueReached(batch.reached, chosen, wanted, from, until)
      eachFrom(from, until): row =>
        wanted(row) = (batch.rewards(row) + settings.discount * batch.goesOn(row) * wanted(row)).toFloat
      critics.criticise(batch, wanted, part, from, until)
    critics.step()
    gradient.clear()
    workers.share(rows): (part, from, until) =>
      choose(actor, batch.seen, from, until)
      critics.slopes(batch.seen, chosen, slopes, from, until)
      eachFrom(from * actions, until * actions): at =>
        pass.outputError(at) = -slopes(at) * (1 - chosen(at) * chosen(at)) / rows
      pass.backward(actor, from, until, gradient.of(part))
    optimiser.step(actor.parameters, gradient.sum())
    actor.changed()
    target.follow(actor, Critics.Rate)
    critics.follow()

  private def choose(by: Network, seen: Array[Float], from: Int, until: Int): Unit =
    pass.forward(by, seen, from, until)
    eachFrom(from * actions, until * actions): at =>
      chosen(at) = StrictMath.tanh(pass.output(at)).toFloat

private object Ddpg:
  /** Standard deviation of the exploration noise. */
  val Deviation = 0.2

  /** Scale of the last layer's initial weights: actions begin near the middle, where tanh is steep. */
  val LastScale = 0.01
