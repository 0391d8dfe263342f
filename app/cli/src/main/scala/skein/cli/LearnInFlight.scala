package skein.cli

import java.nio.file.Path
import mainargs.{ParserForClass, arg}
import skein.learn.LearnerInFlight
import skein.loop.LoopKind
import skein.loop.learning.Learning
import skein.scenario.Scenarios
import skein.settings.{ChosenPolicy, FlySettings, PolicyFile}
import skein.training.LearnFile
import skein.units.Decimals.significant
import skein.units.Expect

/** Options for a policy that learns in flight. */
final case class LearnInFlight(
    @arg(doc =
      "a folder of the command learn, by sac or ddpg: its policy replaces " +
        "the scenario's and goes on learning during the flight"
    )
    learn: Option[String],
    @arg(
      name = "learn-updates",
      doc = "updates of the networks for each decision (default: 1)"
    )
    learnUpdates: Option[Double],
    @arg(
      name = "learn-version",
      doc = "decisions after which a new version flies (default: 20)"
    )
    learnVersion: Option[Int],
    @arg(
      name = "learn-noise",
      doc = "exploration: standard deviation, as a share of the largest turn (default: 0.1)"
    )
    learnNoise: Option[Double]
):
  import LearnInFlight.*

  /** The learner for flights with these settings.
    *
    * @return Left says what was expected, what was given, and in which option
    */
  def chosen(settings: FlySettings)(using Scenarios): Either[String, Option[ChosenPolicy]] =
    val alone =
      Seq("--learn-updates" -> learnUpdates, "--learn-version" -> learnVersion, "--learn-noise" -> learnNoise)
        .collectFirst { case (option, Some(_)) => s"$option: expected with --learn FOLDER" }
    (learn, alone) match
      case (None, Some(mistake)) => Left(mistake)
      case (None, None)          => Right(None)
      case (Some(folder), _)     => of(Path.of(folder), settings).map(Some(_))

  private def of(folder: Path, settings: FlySettings)(using Scenarios): Either[String, ChosenPolicy] =
    val (updates, every, noise) =
      (learnUpdates.getOrElse(1.0), learnVersion.getOrElse(20), learnNoise.getOrElse(0.1))
    for
      _ <- within("--learn-updates", updates, 0.001, 1000)
      _ <- within("--learn-version", every, 1, 1_000_000)
      _ <- within("--learn-noise", noise, 0, 1)
      _ <- Expect.that(!settings.loops.contains(LoopKind.Plan)):
        "--learn: in the loop plan no policy decides; expected other loops"
      _ <- Expect.that(settings.policies.isEmpty):
        "--learn: expected no --policy beside it, got one; fly it apart"
      file  <- LearnFile.read(folder).left.map("--learn: " + _)
      setup <- file.question.setup.left.map(mistake => s"--learn: $folder: $mistake")
      _     <- Expect.that(!setup.isOfTeam):
        s"--learn: expected a policy learned for the distance in a duel, by which a flight rewards it; $folder has " +
          s"an objective of ${file.question.scenario}"
      count = settings.fleet.agents.count(_.role == setup.role)
      _ <- Expect.that(count == 1):
        s"--learn: expected a scenario with one ${PolicyFile.name(setup.role)}, who learns, got $count"
      begun = (seed: Long) =>
        LearnerInFlight.of(
          setup.algorithm,
          file.question.learner,
          setup.role,
          setup.space,
          setup.bounds,
          updates,
          every,
          seed
        )(LearnFile.load(folder, file.state, _))
      first <- begun(settings.seed).left.map("--learn: " + _)
      again = (seed: Long) => begun(seed).fold(reason => throw IllegalStateException(reason), _._2)
    yield ChosenPolicy(
      "learning",
      PolicyFile(setup.role, setup.family, first._1),
      Some(Learning.Beside(noise, again))
    )

object LearnInFlight:
  given ParserForClass[LearnInFlight] = ParserForClass[LearnInFlight]

  private def within(option: String, value: Double, least: Double, most: Double): Either[String, Unit] =
    Expect.that(value >= least && value <= most):
      s"$option: expected ${least.significant(4)} to ${most.significant(4)}, got $value"
