package skein.search

import scala.collection.immutable.ArraySeq
import skein.cluster.BlockSolverFactory
import skein.optimise.RunningStats
import skein.pickle.Fields
import skein.scenario.Scenarios
import skein.units.Expect

/** A search's question as workers receive it.
  *
  * @param probe the defaults' result at the coordinator on the first episodes: a worker with another result,
  *   for example because a file has other content, does not answer the question
  */
final case class VerifiedQuestion(question: PosedSearch, probe: Vector[RunningStats])

object VerifiedQuestion:
  import SearchFile.given
  private given Fields[VerifiedQuestion] = Fields.derived

  /** Refuses to mix results of two programs.
    *
    * @param before the probe of the program that began; empty if it kept none
    * @param began what has begun, for example `the search`
    */
  def unchanged(
      before: Vector[RunningStats],
      now: => Vector[RunningStats],
      began: String
  ): Either[String, Unit] =
    Expect.that(before.isEmpty || RunningStats.areSame(now, before)):
      s"--resume: by this program the first episodes score ${now.head.mean}, and they scored ${before.head.mean} " +
        s"when $began began: expected the program of that time, or to begin anew"

  def bytes(ready: ReadySearch): ArraySeq[Byte] =
    JsonText.bytes(VerifiedQuestion(ready.question, ready.probe))

  /** Answers search questions about the scenarios known to this process. */
  def solvers(using Scenarios): BlockSolverFactory = asked =>
    for
      posed <- JsonText.read[VerifiedQuestion](asked, "a search's question")
      ready <- posed.question.setup
      came = ready.probe
      _ <- Expect.that(RunningStats.areSame(came, posed.probe)):
        s"the defaults come to ${came.head.mean} here and to ${posed.probe.head.mean} at the coordinator; " +
          "has a file that --link, --plant or --opponent names another content here?"
    yield () =>
      val judges = ready.judges(1)
      work => SearchBlock.read(work).fold(wrong => throw IllegalArgumentException(wrong), _.answer(judges))
