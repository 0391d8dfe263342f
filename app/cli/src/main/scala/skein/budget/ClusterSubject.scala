package skein.budget

import scala.collection.immutable.ArraySeq
import skein.cluster.BlockSolverFactory
import skein.optimise.RunningStats
import skein.pickle.Fields
import skein.scenario.Scenarios
import skein.search.SearchFile.given
import skein.search.{BlockExecutor, JsonText}
import skein.signal.LatencyDistribution
import skein.units.Expect

/** A subject simulated by other processes, in blocks of some cells each, with the bits of a run in this
  * process.
  *
  * @param number index of this subject among those of the question
  * @param blockEpisodes approximate number of episodes in a block; without it, as many as take seconds at
  *   most
  */
final class ClusterSubject(
    here: BudgetSubject,
    number: Int,
    elsewhere: BlockExecutor,
    share: () => Double,
    blockEpisodes: Option[Int]
) extends BudgetSubject(here.task):

  export here.{cellEpisodes, engine, truth}

  /** A whole map in one call: the workers share its blocks. */
  override def rowsTogether: Int = Int.MaxValue

  def tallies(cells: BudgetCells): Either[String, Vector[RunningStats]] =
    import cells.{episodes, links}
    val most   = blockEpisodes.getOrElse(ClusterSubject.CellsOfBlock * here.cellEpisodes(links))
    val blocks = links.grouped((most / episodes).max(1)).map(BudgetBlock(number, _, episodes)).toVector
    val total  = links.size.toLong * episodes
    for
      answered <- elsewhere.computed(blocks.map(_.bytes), cells.isCancelled)(
        cells.onProgress((total * share()).toLong)
      )
      answers <- answered.toRight(BudgetSubject.Stopped)
      tallies <- Expect.each(blocks.zip(answers))((block, answer) => block.tallies(answer)).map(_.flatten)
    yield tallies

object ClusterSubject:
  /** Cells in a block at a cell's default number of episodes. */
  private val CellsOfBlock = 8

  /** The question as workers receive it.
    *
    * @param probes each subject's result of one episode at the coordinator: a worker with another result, for
    *   example because a file has other content, does not answer the question
    */
  private final case class ProbedQuestion(questions: Vector[BudgetQuestion], probes: Vector[RunningStats])
      derives Fields

  def bytes(
      questions: Vector[BudgetQuestion],
      subjects: Vector[BudgetSubject]
  ): Either[String, ArraySeq[Byte]] =
    probes(subjects).map(came => JsonText.bytes(ProbedQuestion(questions, came)))

  private def probes(subjects: Vector[BudgetSubject]): Either[String, Vector[RunningStats]] =
    Expect.each(subjects)(_.tallies(BudgetCells(Vector(LatencyDistribution.Vpn), 1)).map(_.head))

  /** Answers budget questions about the scenarios known to this process. */
  def solvers(using Scenarios): BlockSolverFactory = asked =>
    for
      posed <- JsonText.read[ProbedQuestion](asked, "a budget's question")
      came  <- subjects(posed).flatMap(probes)
      _     <- Expect.that(RunningStats.areSame(came, posed.probes)):
        "one episode does not come to the same here and at the " +
          "coordinator; has a file that --plant names another content here?"
    yield () =>
      val own = subjects(posed)
      block =>
        val answer =
          for
            read     <- BudgetBlock.read(block)
            subjects <- own
            answered <- read.answer(subjects)
          yield answered
        answer.fold(wrong => throw IllegalArgumentException(wrong), identity)

  private def subjects(posed: ProbedQuestion)(using Scenarios) =
    Expect.each(posed.questions)(_.subject(threads = 1))
