package skein.learn

import java.io.{DataInput, DataOutput}
import skein.signal.SplitMix64

/** Proximal policy optimisation: collects steps by the newest policy, and learns from them as long as the
  * policy stays near the one that collected them. Source: Schulman, Wolski, Dhariwal, Radford, Klimov,
  * arXiv:1707.06347, equation 7; advantages are normalised over a batch. The policy draws from a normal
  * distribution around tanh of the actor's outputs, with one width for all states; environments clamp actions
  * to ± 1.
  */
final class Ppo(
    observations: Int,
    actions: Int,
    environments: Int,
    settings: LearnerSettings,
    seed: Long,
    workers: BatchThreads
) extends Learner:
  import Ppo.*

  private val initial       = SplitMix64(SplitMix64.seedOf(seed, -1))
  private val actorWidths   = observations +: settings.hidden :+ actions
  private val valueWidths   = observations +: settings.hidden :+ 1
  val actor: Network        = Network(actorWidths).draw(initial, LastScale)
  private[learn] val critic = Network(valueWidths).draw(initial)

  /** Logarithm of the standard deviation of each component of an action. */
  private[learn] val widths         = Array.fill(actions)(StrictMath.log(FirstDeviation).toFloat)
  private val actorOptimiser        = Adam(actor.parameters.length, settings.rate)
  private val criticOptimiser       = Adam(critic.parameters.length, settings.rate)
  private val widthsOptimiser       = Adam(actions, settings.rate)
  private[learn] val rollout        = RolloutBuffer(observations, actions, environments, settings.horizon)
  private val actorPass             = Pass(actorWidths, environments.max(settings.batch))
  private val criticPass            = Pass(valueWidths, environments.max(settings.batch))
  private[learn] val actorGradient  = Gradient(actor.parameters.length, settings.batch)
  private val criticGradient        = Gradient(critic.parameters.length, settings.batch)
  private[learn] val widthsGradient = Gradient(actions, settings.batch)
  private var random                = SplitMix64(seed)
  private val logs, values          = Array.ofDim[Float](environments)

  def isFinite: Boolean = actor.isFinite && critic.isFinite && widths.forall(_.isFinite)

  def begin(round: Long): Unit =
    random = SplitMix64(SplitMix64.seedOf(seed, round))
    rollout.clear()

  def explore(seen: Array[Float], into: Array[Float]): Unit =
    actorPass.forward(actor, seen, 0, environments)
    for row <- 0 until environments do
      var log = 0.0
      for action <- 0 until actions do
        val drawn = Noise.normal(random)
        val at    = row * actions + action
        into(at) = (StrictMath.tanh(actorPass.output(at)) + StrictMath.exp(widths(action)) * drawn).toFloat
        log += -0.5 * drawn * drawn - widths(action)
      logs(row) = log.toFloat
    value(seen, values)

  private def value(seen: Array[Float], into: Array[Float]): Unit =
    criticPass.forward(critic, seen, 0, environments)
    System.arraycopy(criticPass.output, 0, into, 0, environments)

  def learn(seen: Array[Float], chosen: Array[Float], task: Task): Unit =
    val reachedValues = Array.ofDim[Float](environments)
    value(task.reached, reachedValues)
    rollout.add(seen, chosen, logs, values, reachedValues, task)
    if rollout.isFull then lesson()

  require(
    settings.batch <= settings.horizon * environments,
    s"expected batches of at most horizon × environments, ${settings.horizon * environments}, got ${settings.batch}"
  )

  override def end(): Unit = if rollout.rows >= settings.batch then lesson()

  private def lesson(): Unit =
    rollout.estimate(settings.discount, AdvantageDecay)
    val order = Array.range(0, rollout.rows)
    for _ <- 0 until settings.epochs do
      shuffle(order)
      for from <- 0 to rollout.rows - settings.batch by settings.batch do update(order, from)
    rollout.clear()

  private def shuffle(order: Array[Int]): Unit =
    for last <- order.length - 1 to 1 by -1 do
      val other = random.nextInt(last + 1)
      val kept  = order(last)
      order(last) = order(other)
      order(other) = kept

  /** Updates from one batch: rows of the rollout, in this order from `first`. */
  private[learn] def update(order: Array[Int], first: Int): Unit =
    val count     = settings.batch
    val chosen    = order.slice(first, first + count)
    val mean      = chosen.iterator.map(at => rollout.advantages(at).toDouble).sum / count
    val squares   = chosen.iterator.map(at => rollout.advantages(at) - mean).map(off => off * off).sum
    val deviation = math.sqrt(squares / count) + 1e-8
    for gradient <- Seq(actorGradient, criticGradient, widthsGradient) do gradient.clear()
    workers.share(count): (part, from, until) =>
      for row <- from until until do
        val at = chosen(row) * observations
        System.arraycopy(rollout.seen, at, actorPass.input, row * observations, observations)
        System.arraycopy(rollout.seen, at, criticPass.input, row * observations, observations)
      actorPass.forward(actor, from, until)
      criticPass.forward(critic, from, until)
      for row <- from until until do
        val at = chosen(row)
        criticPass.outputError(row) = (criticPass.output(row) - rollout.returns(at)) / count
        improve(row, at, (rollout.advantages(at) - mean) / deviation, count, widthsGradient.of(part))
      actorPass.backward(actor, from, until, actorGradient.of(part))
      criticPass.backward(critic, from, until, criticGradient.of(part))
    val scale = clipped(actorGradient.sum(), widthsGradient.sum())
    clipped(criticGradient.sum(), Array.emptyFloatArray): Unit
    if scale.isFinite then
      actorOptimiser.step(actor.parameters, actorGradient.of(0))
      actor.changed()
      widthsOptimiser.step(widths, widthsGradient.of(0))
    criticOptimiser.step(critic.parameters, criticGradient.of(0))
    critic.changed()

  /** Adds a row's gradient of the lesser of two products: advantage times the likelihood ratio, unclipped,
    * and clipped near 1.
    */
  private def improve(row: Int, at: Int, advantage: Double, count: Int, byWidths: Array[Float]): Unit =
    var log = 0.0
    for action <- 0 until actions do
      val off = offset(row, at, action)
      log += -0.5 * off * off - widths(action)
    val ratio  = StrictMath.exp(log - rollout.logs(at))
    val counts = if advantage >= 0 then ratio <= 1 + Clip else ratio >= 1 - Clip
    val by     = if counts then -advantage * ratio / count else 0.0
    for action <- 0 until actions do
      val off      = offset(row, at, action)
      val squashed = StrictMath.tanh(actorPass.output(row * actions + action))
      actorPass.outputError(row * actions + action) =
        (by * off / StrictMath.exp(widths(action)) * (1 - squashed * squashed)).toFloat
      byWidths(action) += (by * (off * off - 1)).toFloat

  /** Distance of the action from the mean, in standard deviations. */
  private def offset(row: Int, at: Int, action: Int): Double =
    val mean = StrictMath.tanh(actorPass.output(row * actions + action))
    (rollout.actions(at * actions + action) - mean) / StrictMath.exp(widths(action))

  /** Shortens gradients to a joint length of at most [[MostLength]]. */
  private def clipped(gradients: Array[Float]*): Double =
    val length = math.sqrt(gradients.iterator.flatten.map(by => by.toDouble * by).sum)
    if length > MostLength then
      val scale = (MostLength / length).toFloat
      for gradient <- gradients; i <- gradient.indices do gradient(i) = gradient(i) * scale
    length

  private def learned: Vector[Saved] = Vector(actor, critic, actorOptimiser, criticOptimiser, widthsOptimiser)

  def save(out: DataOutput): Unit =
    Saved.write(out, widths)
    learned.foreach(_.save(out))

  def load(in: DataInput): Unit =
    Saved.read(in, widths)
    learned.foreach(_.load(in))

private object Ppo:
  val FirstDeviation = 0.6
  val LastScale      = 0.01
  val AdvantageDecay = 0.95
  val Clip           = 0.2
  val MostLength     = 0.5
