package skein.learn

/** The supported learning algorithms. */
enum Algorithm:
  case Sac, Ddpg, Ppo

  def label: String = toString.toLowerCase(java.util.Locale.ROOT)

  def learner(
      observations: Int,
      actions: Int,
      environments: Int,
      settings: LearnerSettings,
      seed: Long,
      workers: BatchThreads
  ): Learner = this match
    case Sac  => skein.learn.Sac(observations, actions, settings, seed, workers)
    case Ddpg => skein.learn.Ddpg(observations, actions, settings, seed, workers)
    case Ppo  => skein.learn.Ppo(observations, actions, environments, settings, seed, workers)

object Algorithm:
  def parse(text: String): Either[String, Algorithm] = values
    .find(_.label == text)
    .toRight(s"expected ${values.map(_.label).mkString(", ")}, got '$text'")
