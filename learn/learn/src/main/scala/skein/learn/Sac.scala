package skein.learn

import java.io.{DataInput, DataOutput}
import skein.units.{eachBelow, eachFrom}

/** Soft actor-critic: two critics, and a stochastic policy that is rewarded for its entropy, with an adaptive
  * temperature. Source: Haarnoja, Zhou, Hartikainen, Tucker, Ha, Tan, Kumar, Zhu, Gupta, Abbeel, Levine,
  * "Soft actor-critic algorithms and applications", arXiv:1812.05905, with its target entropy of minus one
  * for each component of an action.
  */
final class Sac(observations: Int, actions: Int, settings: LearnerSettings, seed: Long, workers: BatchThreads)
    extends OffPolicy(observations, actions, settings, seed):
  import Sac.*

  private val widths             = observations +: settings.hidden :+ 2 * actions
  val actor: Network             = Network(widths).draw(initial)
  private val optimiser          = Adam(actor.parameters.length, settings.rate)
  private[learn] val critics     = Critics(2, observations, actions, settings, initial)
  private[learn] val temperature = Temperature(settings.rate)
  private val pass               = Pass(widths, rows)
  private[learn] val gradient    = Gradient(actor.parameters.length, rows)
  private[learn] val noise       = Array.ofDim[Float](rows * actions)
  private[learn] val chosen      = Array.ofDim[Float](rows * actions)
  private val slopes             = Array.ofDim[Float](rows * actions)
  private[learn] val logs        = Array.ofDim[Float](rows)
  private[learn] val wanted      = Array.ofDim[Float](rows)

  protected def learned: Vector[Saved] = Vector(actor, optimiser, critics, temperature)

  def isFinite: Boolean = actor.isFinite && critics.isFinite && temperature.log.isFinite

  protected def tried(outputs: Array[Float], at: Int, action: Int): Float =
    val deviation = StrictMath.exp(logDeviation(outputs(at + actions + action)))
    StrictMath.tanh(outputs(at + action) + deviation * Noise.normal(random)).toFloat

  private[learn] def update(): Unit =
    Noise.fill(noise, random)
    critics.clear()
    workers.share(rows): (part, from, until) =>
      want(from, until)
      critics.criticise(batch, wanted, part, from, until)
    critics.step()
    Noise.fill(noise, random)
    gradient.clear()
    workers.share(rows)(improve)
    optimiser.step(actor.parameters, gradient.sum())
    actor.changed()
    temperature.step(logs, actions)
    critics.follow()

  /** Draws actions for rows of observations, with their log-likelihoods. */
  private def draw(seen: Array[Float], from: Int, until: Int): Unit =
    pass.forward(actor, seen, from, until)
    eachFrom(from, until): row =>
      var log = 0.0
      eachBelow(actions): action =>
        val at       = row * actions + action
        val logWidth = logDeviation(pass.output(row * 2 * actions + actions + action))
        val drawn    = noise(at).toDouble
        val raw      = pass.output(row * 2 * actions + action) + StrictMath.exp(logWidth) * drawn
        chosen(at) = StrictMath.tanh(raw).toFloat
        log += -0.5 * drawn * drawn - logWidth - HalfLog2Pi - logSquash(raw)
      logs(row) = log.toFloat

  /** Computes the critics' target values for a part of the batch. */
  private[learn] def want(from: Int, until: Int): Unit =
    draw(batch.reached, from, until)
    critics.valueReached(batch.reached, chosen, wanted, from, until)
    val alpha = temperature.value
    eachFrom(from, until): row =>
      wanted(row) = (batch.rewards(row) +
        settings.discount * batch.goesOn(row) * (wanted(row) - alpha * logs(row))).toFloat

  /** The gradient of temperature times log-likelihood, minus value. */
  private[learn] def improve(part: Int, from: Int, until: Int): Unit =
    draw(batch.seen, from, until)
    critics.slopes(batch.seen, chosen, slopes, from, until)
    val alpha = temperature.value
    eachFrom(from, until): row =>
      eachBelow(actions): action =>
        val at    = row * actions + action
        val mean  = row * 2 * actions + action
        val share = chosen(at).toDouble
        // With respect to the value before tanh: the log of its derivative has the slope −2 tanh.
        val byRaw   = alpha * 2 * share - slopes(at) * (1 - share * share)
        val output  = pass.output(mean + actions)
        val byWidth = byRaw * StrictMath.exp(logDeviation(output)) * noise(at) - alpha
        pass.outputError(mean) = (byRaw / rows).toFloat
        pass.outputError(mean + actions) = (byWidth * logDeviationSlope(output) / rows).toFloat
    pass.backward(actor, from, until, gradient.of(part))

private[learn] object Sac:
  private val HalfLog2Pi = 0.5 * StrictMath.log(2 * math.Pi)
  private val LeastLog   = -5.0
  private val MostLog    = 2.0

  /** The log standard deviation, bounded to e⁻⁵ to e² for any output. */
  def logDeviation(output: Double): Double =
    LeastLog + 0.5 * (MostLog - LeastLog) * (StrictMath.tanh(output) + 1)

  def logDeviationSlope(output: Double): Double =
    val squashed = StrictMath.tanh(output)
    0.5 * (MostLog - LeastLog) * (1 - squashed * squashed)

  /** log(1 − tanh²), accurate where it is tiny. */
  def logSquash(raw: Double): Double =
    2 * (Log2 - raw - (if raw < -20 then -2 * raw else StrictMath.log1p(StrictMath.exp(-2 * raw))))

  private val Log2 = StrictMath.log(2)

/** The weight of entropy: it rises while the policy's entropy is below its target. */
private[learn] final class Temperature(rate: Double) extends Saved:
  private val logarithm = Array(StrictMath.log(0.1).toFloat)
  private val optimiser = Adam(1, rate)

  def log: Float    = logarithm(0)
  def value: Double = StrictMath.exp(log)

  /** @param logs log-likelihoods of the drawn actions */
  def step(logs: Array[Float], actions: Int): Unit =
    var sum = 0.0
    for log <- logs do sum += log - actions
    optimiser.step(logarithm, Array((-sum / logs.length).toFloat))

  def save(out: DataOutput): Unit =
    out.writeFloat(log)
    optimiser.save(out)

  def load(in: DataInput): Unit =
    logarithm(0) = in.readFloat()
    optimiser.load(in)
