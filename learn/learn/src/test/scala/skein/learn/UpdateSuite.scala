package skein.learn

import skein.signal.SplitMix64

/** Each learner's update, compared with an independent computation of its definition. */
class UpdateSuite extends munit.FunSuite:
  private val settings =
    LearnerSettings(hidden = Vector(6), discount = 0.9, rate = 1e-2, batch = 4, replay = 16, randomSteps = 0)

  private def fill(array: Array[Float], random: SplitMix64): Unit =
    for i <- array.indices do array(i) = (2 * random.nextDouble() - 1).toFloat

  private def drawn(batch: Transitions): Unit =
    val random = SplitMix64(11)
    for array <- Seq(batch.seen, batch.actions, batch.reached, batch.rewards) do fill(array, random)
    java.util.Arrays.fill(batch.goesOn, 1f)
    batch.goesOn(2) = 0

  private def run(network: Network, input: Array[Float]): Array[Double] =
    val pass = Pass(network.widths, 1)
    System.arraycopy(input, 0, pass.input, 0, input.length)
    pass.forward(network, 0, 1)
    pass.output.map(_.toDouble)

  private def value(network: Network, seen: Array[Float], action: Double) =
    run(network, seen :+ action.toFloat)(0)

  private def row(array: Array[Float], at: Int, width: Int) = array.slice(at * width, (at + 1) * width)

  private def assertSlopes(network: Network, gradient: Array[Float])(loss: () => Double): Unit =
    for at <- network.parameters.indices do
      val (kept, step) = (network.parameters(at), 1f / 512)
      network.parameters(at) = kept + step
      network.changed()
      val above = loss()
      network.parameters(at) = kept - step
      network.changed()
      val below = loss()
      network.parameters(at) = kept
      network.changed()
      assertEqualsDouble(gradient(at).toDouble, (above - below) / (2 * step), 4e-3, s"parameter $at")

  test("SAC: critics' targets are the reward and the discounted soft value of the reached state"):
    val sac = Sac(2, 1, settings, 3, BatchThreads(1))
    drawn(sac.batch)
    Noise.fill(sac.noise, SplitMix64(5))
    sac.want(0, 4)
    for at <- 0 until 4 do
      val reached           = row(sac.batch.reached, at, 2)
      val Array(mean, wide) = run(sac.actor, reached)
      val deviation         = math.exp(-5 + 3.5 * (math.tanh(wide) + 1))
      val raw               = mean + deviation * sac.noise(at)
      val action            = math.tanh(raw)
      // Density of a normal number squashed by tanh.
      val density =
        math.exp(-0.5 * math.pow((raw - mean) / deviation, 2)) / (deviation * math.sqrt(2 * math.Pi)) /
          (1 - action * action)
      val soft = sac.critics.targets.map(value(_, reached, action)).min - 0.1 * math.log(density)
      assertEqualsDouble(
        sac.wanted(at).toDouble,
        sac.batch.rewards(at) + 0.9 * sac.batch.goesOn(at) * soft,
        1e-4,
        s"row $at"
      )

  test("SAC: the actor's gradient is that of temperature times log-likelihood minus the lesser value"):
    val sac = Sac(2, 1, settings, 6, BatchThreads(1))
    drawn(sac.batch)
    Noise.fill(sac.noise, SplitMix64(8))
    sac.gradient.clear()
    sac.improve(0, 0, 4)
    assertSlopes(sac.actor, sac.gradient.of(0)): () =>
      (0 until 4).map: at =>
        val seen              = row(sac.batch.seen, at, 2)
        val Array(mean, wide) = run(sac.actor, seen)
        val logDeviation      = -5 + 3.5 * (math.tanh(wide) + 1)
        val drawn             = sac.noise(at).toDouble
        val action            = math.tanh(mean + math.exp(logDeviation) * drawn)
        val log               = -0.5 * drawn * drawn - logDeviation - math.log(1 - action * action)
        0.1 * log - sac.critics.networks.map(value(_, seen, action)).min
      .sum / 4

  test("SAC: the temperature rises while actions are drawn less widely than wanted, and falls after"):
    val temperature = Temperature(0.01)
    val before      = temperature.log
    temperature.step(Array(3f, 2f), actions = 1)
    assert(temperature.log > before)
    temperature.step(Array(-9f, -9f), actions = 1)
    temperature.step(Array(-9f, -9f), actions = 1)
    assert(temperature.log < before)

  test("the logarithm of squashing is accurate where tanh is near its bounds"):
    for raw <- Seq(-3.0, -0.5, 0.0, 1.0, 4.0) do
      assertEqualsDouble(Sac.logSquash(raw), math.log(1 - math.pow(math.tanh(raw), 2)), 1e-9)
    assertEqualsDouble(Sac.logSquash(-40), 2 * math.log(2) - 80, 1e-9)
    assertEqualsDouble(Sac.logSquash(40), 2 * math.log(2) - 80, 1e-9)

  test("critics: the gradient is that of half the mean squared error"):
    val critics = Critics(1, 2, 1, settings, SplitMix64(2))
    val batch   = Transitions(2, 1, 4)
    drawn(batch)
    val wanted = Array(0.5f, -0.2f, 0.1f, 0.9f)
    critics.clear()
    critics.criticise(batch, wanted, 0, 0, 4)
    val network = critics.networks.head
    // A step against the gradient is visible only by sign: Adam's first step is the rate times the gradient's
    // sign.
    val before = network.parameters.clone
    val loss   = () =>
      (0 until 4).map(at =>
        math.pow(value(network, row(batch.seen, at, 2), batch.actions(at).toDouble) - wanted(at), 2)
      ).sum / 8
    val slopes = network.parameters.indices.map: at =>
      network.parameters(at) = before(at) + 1f / 512
      val above = loss()
      network.parameters(at) = before(at) - 1f / 512
      val below = loss()
      network.parameters(at) = before(at)
      (above - below) * 256
    critics.step()
    for at <- slopes.indices if math.abs(slopes(at)) > 5e-3 do
      assertEqualsDouble(
        (network.parameters(at) - before(at)).toDouble,
        -0.01 * math.signum(slopes(at)),
        1e-4
      )

  test("DDPG: an update moves the actor towards higher values"):
    val ddpg = Ddpg(2, 1, settings, 6, BatchThreads(1))
    drawn(ddpg.batch)
    def worth() = (0 until 4).map: at =>
      val seen = row(ddpg.batch.seen, at, 2)
      value(ddpg.critics.networks.head, seen, math.tanh(run(ddpg.actor, seen)(0)))
    .sum
    for _ <- 0 until 20 do ddpg.update()
    val actor  = ddpg.actor.parameters.clone
    val after  = worth()
    val critic = ddpg.critics.networks.head.parameters.clone
    ddpg.update()
    // By the same critic as before the update.
    System.arraycopy(critic, 0, ddpg.critics.networks.head.parameters, 0, critic.length)
    ddpg.critics.networks.head.changed()
    assertNotEquals(ddpg.actor.parameters.toVector, actor.toVector)
    assert(worth() > after - 1e-3, s"${worth()} and $after before")

  test("PPO: advantages equal hand-computed ones, over terminations and truncations"):
    final class Three extends SmallTask(1, 1, 1):
      protected def start(row: Int): Unit  = ()
      def step(chosen: Array[Float]): Unit = ()
    val (task, buffer) = (Three(), RolloutBuffer(1, 1, 1, 4))
    // Rewards 1 to 4; values 0.5; reached states are worth 2. The second step terminates, the third is cut
    // off.
    for step <- 0 until 4 do
      task.rewards(0) = (step + 1).toFloat
      task.terminated(0) = step == 1
      task.ended(0) = step == 1 || step == 2
      buffer.add(Array(0f), Array(0f), Array(0f), Array(0.5f), Array(2f), task)
    buffer.estimate(discount = 0.5, decay = 0.5)
    val fourth = 4 + 0.5 * 2 - 0.5
    val third  = 3 + 0.5 * 2 - 0.5
    val second = 2 - 0.5
    val first  = 1 + 0.5 * 2 - 0.5 + 0.25 * second
    for (expected, at) <- Seq(first, second, third, fourth).zipWithIndex do
      assertEqualsDouble(buffer.advantages(at).toDouble, expected, 1e-6)
      assertEqualsDouble(buffer.returns(at).toDouble, expected + 0.5, 1e-6)

  test("PPO: the actor's gradient is that of the clipped objective"):
    val ppo    = Ppo(2, 1, 4, settings.copy(horizon = 1, rate = 1e-12), 9, BatchThreads(1))
    val random = SplitMix64(3)
    fill(ppo.rollout.seen, random)
    fill(ppo.rollout.actions, random)
    fill(ppo.rollout.advantages, random)
    def logs(at: Int) =
      val mean      = math.tanh(run(ppo.actor, row(ppo.rollout.seen, at, 2))(0))
      val deviation = math.exp(ppo.widths(0))
      -0.5 * math.pow((ppo.rollout.actions(at) - mean) / deviation, 2) - ppo.widths(0)
    // One of them is far from the collecting policy: its part is clipped.
    for at <- 0 until 4 do ppo.rollout.logs(at) = (logs(at) + Seq(0.05, -1.0, 0.1, 1.0)(at)).toFloat
    val mean      = ppo.rollout.advantages.map(_.toDouble).sum / 4
    val deviation = math.sqrt(ppo.rollout.advantages.map(a => math.pow(a - mean, 2)).sum / 4)
    def loss()    =
      -(0 until 4).map: at =>
        val advantage = (ppo.rollout.advantages(at) - mean) / deviation
        val ratio     = math.exp(logs(at) - ppo.rollout.logs(at))
        math.min(ratio * advantage, ratio.max(0.8).min(1.2) * advantage)
      .sum / 4
    ppo.update(Array(0, 1, 2, 3), 0)
    // The gradient was made shorter by one factor at most.
    val gradient = ppo.actorGradient.of(0)
    val slopes   = ppo.actor.parameters.indices.map: at =>
      val kept = ppo.actor.parameters(at)
      ppo.actor.parameters(at) = kept + 1f / 512
      val above = loss()
      ppo.actor.parameters(at) = kept - 1f / 512
      val below = loss()
      ppo.actor.parameters(at) = kept
      (above - below) * 256
    val widest = slopes.indices.maxBy(at => math.abs(slopes(at)))
    val scale  = gradient(widest) / slopes(widest)
    assert(scale > 0 && scale <= 1.01, s"scale $scale")
    for at <- slopes.indices do
      assertEqualsDouble(gradient(at).toDouble, slopes(at) * scale, 4e-3, s"parameter $at")
