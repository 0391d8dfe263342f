package skein.training

import java.io.{
  BufferedInputStream,
  DataInputStream,
  DataOutputStream,
  EOFException,
  IOException
}
import java.nio.file.{Files, NoSuchFileException, Path}
import java.util.zip.{CRC32C, CheckedInputStream, CheckedOutputStream}
import scala.util.Using
import skein.learn.Learner
import skein.optimise.RunningStats
import skein.pickle.Fields
import skein.record.FileReason
import skein.search.SearchFile.given
import skein.search.{NamedFiles, StateFile}
import skein.units.Expect

/** The progress of learning.
  *
  * @param rounds number of completed rounds
  * @param scores the policy's scores in the course of learning
  */
final case class LearnState(
    rounds: Int = 0,
    scores: Vector[LearnScore] = Vector.empty,
    best: Option[LearnBest] = None
) derives Fields

/** @param steps total number of steps of all environments before the evaluation
  * @param mean mean objective over the evaluation's episodes
  */
final case class LearnScore(steps: Long, mean: Double, sd: Double) derives Fields

/** The policy with the best score so far.
  *
  * @param weights the network's weights, for a [[skein.policy.LearnedPolicy]]
  */
final case class LearnBest(steps: Long, mean: Double, weights: Vector[Double]) derives Fields

/** A learning task on disk: `learn.json` with question and state, and next to it the learner's state.
  *
  * @param files [[NamedFiles.digests]] of the names in the question
  * @param probe [[LearnSetup.probe]] of the program that wrote it; empty in older files
  */
final case class LearnFile(
    version: Int,
    question: LearnQuestion,
    state: LearnState,
    files: Map[String, String] = Map.empty,
    probe: Vector[RunningStats] = Vector.empty
) derives Fields

object LearnFile:
  val Name           = "learn.json"
  val Version        = 2
  private val onDisk = StateFile[LearnFile](Name, Version, "learning, of ./skein learn")
  export onDisk.read

  /** Digests of the current content of the files that a question names. */
  def files(question: LearnQuestion): Map[String, String] =
    NamedFiles.digests(Seq(question.link, question.conditions.plant))

  private def numbers(folder: Path, rounds: Int) = folder.resolve(s"learner-$rounds.bin")

  /** Restores a learner to its state after these rounds. */
  def load(folder: Path, state: LearnState, learner: Learner): Either[String, Unit] =
    if state.rounds == 0 then Right(())
    else
      val file = numbers(folder, state.rounds)
      try
        val sum = CRC32C()
        Using.resource(BufferedInputStream(Files.newInputStream(file), StateFile.Buffer)): bytes =>
          learner.load(DataInputStream(CheckedInputStream(bytes, sum)))
          val isWhole = DataInputStream(bytes).readLong() == sum.getValue && bytes.read() < 0
          Expect.that(isWhole && learner.isFinite):
            s"$file: expected the learner's numbers as they were written; " +
              "their checksum says that they were damaged since"
      catch
        case _: NoSuchFileException =>
          Left(s"there is no $file; expected the learner's numbers there, beside $Name")
        case _: EOFException     => Left(s"$file: expected the learner's numbers, got a file that is cut off")
        case failed: IOException =>
          Left(s"$file: expected the numbers of such a learner: ${failed.getMessage}")

  /** Writes all files atomically: after a crash the folder has either the old or the new state. */
  def write(
      folder: Path,
      stored: LearnFile,
      learner: Learner
  ): Either[String, Unit] =
    val file = numbers(folder, stored.state.rounds)
    for
      _ <- StateFile.replace(file, folder.resolve("learner.new")): bytes =>
        val sum = CRC32C()
        learner.save(DataOutputStream(CheckedOutputStream(bytes, sum)))
        DataOutputStream(bytes).writeLong(sum.getValue)
      _ <- onDisk.write(folder, stored)
      _ <- FileReason.attempt(why => s"cannot delete what was before $file: $why"):
        Using.resource(Files.newDirectoryStream(folder, "learner-*.bin")):
          _.forEach(other => if other != file then Files.delete(other))
    yield ()
