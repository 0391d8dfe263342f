package skein.training

import java.io.{BufferedInputStream, BufferedOutputStream, DataInputStream, DataOutputStream, IOException}
import java.nio.file.{Files, Path, StandardCopyOption}
import skein.learn.Learner
import upickle.default.{ReadWriter, read as readJson, write as writeJson}

/** How far learning has come.
  *
  * @param rounds
  *   that are done
  * @param scores
  *   of the policy, as it grew
  */
final case class LearnState(
    rounds: Int = 0,
    scores: Vector[LearnScore] = Vector.empty,
    best: Option[LearnBest] = None
) derives ReadWriter

/** @param steps
  *   of all environments before it
  * @param mean
  *   of the objective over the episodes of judging
  */
final case class LearnScore(steps: Long, mean: Double, sd: Double) derives ReadWriter

/** The policy with the best score so far.
  *
  * @param weights
  *   of a [[skein.policy.LearnedPolicy]]
  */
final case class LearnBest(steps: Long, mean: Double, weights: Vector[Double]) derives ReadWriter

/** Learning as it stands on disk: `learn.json` with question and state, and beside it all numbers of the learner. */
final case class LearnFile(version: Int, question: LearnQuestion, state: LearnState) derives ReadWriter

object LearnFile:
  val Name    = "learn.json"
  val Version = 1

  private def numbers(folder: Path, rounds: Int) = folder.resolve(s"learner-$rounds.bin")

  /** Reads `learn.json` of a folder.
    *
    * @return
    *   or why it cannot be gone on with
    */
  def read(folder: Path): Either[String, LearnFile] =
    val file = folder.resolve(Name)
    try
      val text    = Files.readString(file)
      val version = ujson.read(text)("version").num.toInt
      if version != Version then Left(s"$file: expected version $Version, came $version")
      else Right(readJson[LearnFile](text))
    catch
      case _: IOException     => Left(s"cannot read $file: expected the folder of ./skein learn")
      case mistake: Exception => Left(s"$file: expected the state of learning, came: ${mistake.getMessage}")

  /** Fills a learner with the numbers that it had after these rounds. */
  def load(folder: Path, state: LearnState, learner: Learner): Either[String, Unit] =
    if state.rounds == 0 then Right(())
    else
      val file = numbers(folder, state.rounds)
      try
        val in = DataInputStream(BufferedInputStream(Files.newInputStream(file), Buffer))
        try
          learner.load(in)
          Either.cond(
            in.read() < 0 && learner.isFinite,
            (),
            s"$file: expected the numbers of such a learner, came others"
          )
        finally in.close()
      catch case failed: IOException => Left(s"cannot read $file: $failed")

  /** Whatever happens meanwhile, the folder has what was written before, or all of this. */
  def write(
      folder: Path,
      question: LearnQuestion,
      state: LearnState,
      learner: Learner
  ): Either[String, Unit] =
    try
      val file = numbers(folder, state.rounds)
      val out  = DataOutputStream(BufferedOutputStream(Files.newOutputStream(file), Buffer))
      try learner.save(out)
      finally out.close()
      val written = folder.resolve(s"$Name.new")
      Files.writeString(written, writeJson(LearnFile(Version, question, state)))
      Files.move(
        written,
        folder.resolve(Name),
        StandardCopyOption.ATOMIC_MOVE,
        StandardCopyOption.REPLACE_EXISTING
      )
      val old = Files.newDirectoryStream(folder, "learner-*.bin")
      try old.forEach(other => if other != file then Files.delete(other))
      finally old.close()
      Right(())
    catch case failed: IOException => Left(s"cannot write into $folder: $failed")

  private val Buffer = 1 << 20
