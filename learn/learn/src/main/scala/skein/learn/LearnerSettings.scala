package skein.learn

/** Settings of a learner.
  *
  * @param hidden widths of the hidden layers of all networks
  * @param discount factor on a reward for each step of delay
  * @param rate Adam's step size
  * @param batch number of transitions in an update
  * @param replay maximum number of transitions that SAC and DDPG remember
  * @param updatesPerStep number of updates by SAC and DDPG per step of one environment
  * @param randomSteps number of random steps, of all environments together, before SAC and DDPG use their
  *   policy
  * @param horizon number of steps of each environment between two of PPO's lessons
  * @param epochs number of times that PPO uses the collected steps
  */
final case class LearnerSettings(
    hidden: Vector[Int] = Vector(64, 64),
    discount: Double = 0.99,
    rate: Double = 1e-3,
    batch: Int = 256,
    replay: Int = 300_000,
    updatesPerStep: Double = 0.125,
    randomSteps: Int = 4096,
    horizon: Int = 100,
    epochs: Int = 10
):
  import LearnerSettings.MostBatch

  def mistake: Option[String] = Seq(
    Option.when(!(discount >= 0 && discount < 1))(s"discount: expected 0 up to less than 1, got $discount"),
    Option.when(!(rate > 0 && rate <= 1))(s"learning rate: expected more than 0 and up to 1, got $rate"),
    Option.when(batch < 1 || batch > MostBatch)(s"batch: expected 1 to $MostBatch, got $batch"),
    Option.when(replay < batch || replay > 10_000_000)(
      s"replay: expected the batch, $batch, to 10000000, got $replay"
    ),
    Option.when(!(updatesPerStep > 0 && updatesPerStep <= 100))(
      s"updates per step: expected more than 0 and up to 100, got $updatesPerStep"
    ),
    Option.when(randomSteps < 0)(s"random steps: expected 0 or more, got $randomSteps"),
    Option.when(horizon < 1 || horizon > 100_000)(s"horizon: expected 1 to 100000, got $horizon"),
    Option.when(epochs < 1 || epochs > 1000)(s"epochs: expected 1 to 1000, got $epochs"),
    Option.when(hidden.size > 8 || hidden.exists(width => width < 1 || width > 256))(
      s"network: expected at most 8 hidden layers of 1 to 256, got ${hidden.mkString("x")}"
    )
  ).flatten.headOption

object LearnerSettings:
  private val MostBatch = 65_536
