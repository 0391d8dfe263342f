package skein.learn

import java.io.{ByteArrayInputStream, ByteArrayOutputStream, DataInputStream, DataOutputStream, IOException}
import skein.testing.Unhurried

class LearnerSimulation extends munit.FunSuite, Unhurried:
  private val small = LearnerSettings(
    hidden = Vector(32, 32),
    discount = 0.9,
    rate = 3e-3,
    batch = 128,
    replay = 20_000,
    updatesPerStep = 0.25,
    randomSteps = 256,
    horizon = 20,
    epochs = 10
  )

  private def trained(
      algorithm: Algorithm,
      task: Task,
      rounds: Int,
      seed: Long = 5,
      threads: Int = 1,
      settings: LearnerSettings = small
  ): Learner =
    val workers = BatchThreads(threads)
    try
      val learner  = algorithm.learner(task.observations, task.actions, task.count, settings, seed, workers)
      val training = Training(task, learner, stepsPerRound = 20)
      for round <- 0 until rounds do assert(training.round(round).isRight)
      learner
    finally workers.close()

  private def action(learner: Learner, seen: Float): Double =
    val pass = Pass(learner.actor.widths, 1)
    pass.input(0) = seen
    pass.forward(learner.actor, 0, 1)
    math.tanh(pass.output(0))

  test("rewards or weights of NaN end the round with the reason"):
    /** A task with an observation or reward of NaN at its last step. */
    final class Broken(reward: Float, shown: Float) extends SmallTask(4, 2, 1):
      private var steps                    = 0
      protected def start(row: Int): Unit  = ()
      def step(chosen: Array[Float]): Unit =
        steps += 1
        if steps == 20 then
          rewards(2) = reward
          seen(5) = shown
    def told(task: Task, spoilt: Boolean = false) =
      val learner = Algorithm.Ddpg.learner(2, 1, 4, small.copy(randomSteps = 0), 4, BatchThreads(1))
      if spoilt then java.util.Arrays.fill(learner.actor.parameters, Float.NaN)
      Training(task, learner, stepsPerRound = 100).round(6)
    assertEquals(
      told(Broken(Float.NaN, 0)),
      Left("round 7: expected a finite reward, got NaN in environment 2")
    )
    assertEquals(
      told(Broken(0, Float.PositiveInfinity)),
      Left("round 7: expected finite observations, got Infinity as number 1 in environment 2")
    )
    assert(clue(told(
      Broken(0, 0),
      spoilt = true
    )).left.exists(_.contains("the weights are not finite any more")))

  for algorithm <- Algorithm.values do
    test(s"${algorithm.label} finds the best action of a single step"):
      val learner = trained(algorithm, HalfOfIt(32, 1), rounds = 30)
      for seen <- Seq(-0.8f, -0.3f, 0f, 0.4f, 0.9f) do
        assertEqualsDouble(action(learner, seen), seen / 2.0, 0.12, s"at $seen")

    test(s"${algorithm.label} brings an integrator to rest"):
      val learner = trained(algorithm, Integrator(32, 2), rounds = 40)
      for start <- Seq(-1f, -0.4f, 0.7f) do
        var x = start
        for _ <- 0 until 15 do x += (0.2 * action(learner, x)).toFloat
        assertEqualsDouble(x.toDouble, 0, 0.1, s"from $start")

    test(s"${algorithm.label}: equal seeds give equal weights to the bit, on any number of threads"):
      def weights(threads: Int, seed: Long) =
        trained(
          algorithm,
          Integrator(16, 3),
          rounds = 3,
          seed = seed,
          threads = threads
        ).actor.parameters.toVector
      val one = weights(threads = 1, seed = 8)
      assertEquals(weights(threads = 3, seed = 8), one)
      assertNotEquals(weights(threads = 1, seed = 9), one)

    test(s"${algorithm.label}: training saved between rounds continues as if uninterrupted"):
      val workers       = BatchThreads(1)
      def fresh()       = algorithm.learner(1, 1, 16, small, 4, workers)
      val (task, whole) = (Integrator(16, 4), fresh())
      val first         = Training(task, whole, 20)
      for round <- 0 until 2 do first.round(round): Unit
      val bytes = ByteArrayOutputStream()
      whole.save(DataOutputStream(bytes))
      for round <- 2 until 4 do first.round(round): Unit
      val second = fresh()
      second.load(DataInputStream(ByteArrayInputStream(bytes.toByteArray)))
      val rest = Training(Integrator(16, 4), second, 20)
      for round <- 2 until 4 do rest.round(round): Unit
      assertEquals(second.actor.parameters.toVector, whole.actor.parameters.toVector)

    test(s"${algorithm.label}: a checkpoint of another shape is refused"):
      val workers = BatchThreads(1)
      val bytes   = ByteArrayOutputStream()
      algorithm.learner(1, 1, 16, small, 4, workers).save(DataOutputStream(bytes))
      val other = algorithm.learner(1, 1, 16, small.copy(hidden = Vector(8)), 4, workers)
      intercept[IOException](other.load(DataInputStream(ByteArrayInputStream(bytes.toByteArray)))): Unit

  test("a learner whose weights become NaN after the round reports that"):
    final class Spoiling extends SmallTask(16, 1, 1):
      private var spoil                                     = () => ()
      override def begin(round: Long, actor: Network): Unit =
        super.begin(round, actor)
        spoil = () => java.util.Arrays.fill(actor.parameters, Float.NaN)
      protected def start(row: Int): Unit  = seen(row) = drawn()
      def step(chosen: Array[Float]): Unit = spoil()
    val training = Training(Spoiling(), Algorithm.Ddpg.learner(1, 1, 16, small, 4, BatchThreads(1)), 1)
    assert(clue(training.round(0)).left.exists(_.contains("the weights are not finite any more")))

  test("settings out of bounds are refused"):
    assert(small.copy(discount = 1).mistake.exists(_.contains("discount")))
    assert(small.copy(rate = Double.NaN).mistake.exists(_.contains("learning rate")))
    assert(small.copy(hidden = Vector(0)).mistake.exists(_.contains("network")))
    assertEquals(small.mistake, None)
