package skein.learn

import java.io.{DataInput, DataOutput}
import skein.signal.SplitMix64
import skein.units.{eachBelow, eachFrom}

/** The value of an action in a state, by one network or the minimum value of several. Copies of the networks
  * follow them slowly and give the target values.
  */
private[learn] final class Critics(
    count: Int,
    observations: Int,
    actions: Int,
    settings: LearnerSettings,
    random: SplitMix64
) extends Saved:
  private val inputs = observations + actions
  private val rows   = settings.batch
  private val widths = inputs +: settings.hidden :+ 1
  val networks       = Vector.fill(count)(Network(widths).draw(random))
  val targets        = networks.map: network =>
    val copy = Network(widths)
    copy.take(network)
    copy
  private val optimisers = networks.map(network => Adam(network.parameters.length, settings.rate))
  private val passes     = networks.map(_ => Pass(widths, rows))
  private val gradients  = networks.map(network => Gradient(network.parameters.length, rows))

  def isFinite: Boolean = networks.forall(_.isFinite)

  def clear(): Unit = gradients.foreach(_.clear())

  private def feed(seen: Array[Float], chosen: Array[Float], from: Int, until: Int): Unit =
    for pass <- passes do
      eachFrom(from, until): row =>
        System.arraycopy(seen, row * observations, pass.input, row * inputs, observations)
        System.arraycopy(chosen, row * actions, pass.input, row * inputs + observations, actions)

  private def least(row: Int): Float =
    var value = passes(0).output(row)
    eachFrom(1, passes.length): other =>
      value = Math.min(value, passes(other).output(row))
    value

  /** Values of the reached states by the slow copies. */
  def valueReached(
      reached: Array[Float],
      chosen: Array[Float],
      into: Array[Float],
      from: Int,
      until: Int
  ): Unit =
    feed(reached, chosen, from, until)
    for (pass, target) <- passes.zip(targets) do pass.forward(target, from, until)
    for row <- from until until do into(row) = least(row)

  /** Adds the gradient of half the mean squared error of the values against `wanted`. */
  def criticise(batch: Transitions, wanted: Array[Float], part: Int, from: Int, until: Int): Unit =
    feed(batch.seen, batch.actions, from, until)
    for ((pass, network), gradient) <- passes.zip(networks).zip(gradients) do
      pass.forward(network, from, until)
      eachFrom(from, until): row =>
        pass.outputError(row) = (pass.output(row) - wanted(row)) / rows
      pass.backward(network, from, until, gradient.of(part))

  def step(): Unit =
    for ((network, optimiser), gradient) <- networks.zip(optimisers).zip(gradients) do
      optimiser.step(network.parameters, gradient.sum())
      network.changed()

  /** Gradient of the minimum value with respect to the actions. */
  def slopes(seen: Array[Float], chosen: Array[Float], into: Array[Float], from: Int, until: Int): Unit =
    feed(seen, chosen, from, until)
    for (pass, network) <- passes.zip(networks) do pass.forward(network, from, until)
    eachFrom(from, until): row =>
      val value = least(row)
      var taken = false
      for pass <- passes do
        val counts = !taken && pass.output(row) == value
        pass.outputError(row) = if counts then 1 else 0
        taken |= counts
    for (pass, network) <- passes.zip(networks) do pass.backwardToInput(network, from, until)
    eachFrom(from, until): row =>
      eachBelow(actions): action =>
        var sum = 0f
        for pass <- passes do sum += pass.inputError(row * inputs + observations + action)
        into(row * actions + action) = sum

  def follow(): Unit =
    for (target, network) <- targets.zip(networks) do target.follow(network, Critics.Rate)

  def save(out: DataOutput): Unit = (networks ++ targets ++ optimisers).foreach(_.save(out))
  def load(in: DataInput): Unit   = (networks ++ targets ++ optimisers).foreach(_.load(in))

private[learn] object Critics:
  /** The fraction by which slow copies follow at an update. */
  val Rate = 0.005f
