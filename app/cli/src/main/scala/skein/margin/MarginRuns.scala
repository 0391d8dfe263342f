package skein.margin

import scala.util.control.NonFatal
import skein.flight.InParallel
import skein.signal.{LatencyProfile, SplitMix64}
import skein.units.Decimals.brief

/** All runs of a margin, in turns over the links, so that a change of the machine's load affects all links
  * alike.
  *
  * @param run executes one run over a link, with a seed; Left says why it could not begin
  * @param atOnce maximum number of simultaneous runs
  * @param isStopped whether no further run begins
  * @param onEnded receives a line for each run that has ended
  */
final class MarginRuns(
    run: (LatencyProfile, Long) => Either[String, MarginRuns.Outcome],
    judge: MarginJudge,
    repeats: Int,
    atOnce: Int,
    seed: Long,
    isStopped: () => Boolean,
    onEnded: String => Unit
):
  import MarginRuns.*

  /** Executes all runs. Blocks. A run that cannot begin has no result; runs cut short are left out.
    *
    * @param links the first one is the reference: if the program fails in its first run there, no other
    *   follows
    * @return Left says why there are none
    */
  def fly(links: Vector[LatencyProfile]): Either[String, Flown] =
    one(links, Run(0, 0)).flatMap: first =>
      first.ended.run.value match
        case Left(MarginRun.NoResult.OfProgram(why)) if !first.ended.isCut => Left(s"without a link: $why")
        case _                                                             =>
          val others =
            for
              repeat <- (0 until repeats).toVector
              link   <- links.indices if repeat > 0 || link > 0
            yield Run(link, repeat)
          val done = InParallel.map(others, atOnce)(run => Option.unless(isStopped())(further(links, run)))
          Right(flown(links, first +: done.flatten))

  private def one(links: Vector[LatencyProfile], which: Run): Either[String, Done] =
    run(links(which.link), SplitMix64.seedOf(seed, which.repeat * links.size + which.link))
      .map(told(links, which, _))

  /** A run after the first, whose program could be run. */
  private def further(links: Vector[LatencyProfile], which: Run): Done =
    val done =
      try one(links, which)
      catch case NonFatal(failure) => Left(Option(failure.getMessage).getOrElse(failure.toString))
    done.fold(why => told(links, which, notRun(s"it could not be run: $why")), identity)

  private def told(links: Vector[LatencyProfile], which: Run, ended: Outcome): Done =
    val came = ended.run.value.fold(_.why, value => s"${judge.name} ${value.brief} ${judge.unit}".trim)
    if !ended.isCut then onEnded(s"${links(which.link).name}, run ${which.repeat + 1} of $repeats: $came")
    Done(which, ended)

  private def flown(links: Vector[LatencyProfile], done: Vector[Done]) =
    val whole = done.filterNot(_.ended.isCut)
    Flown(
      links.zipWithIndex.map((link, index) =>
        MarginPoint(link, whole.filter(_.which.link == index).map(_.ended.run))
      ),
      done.map(one => (links(one.which.link).name, one.which.repeat + 1, one.ended.printed))
    )

object MarginRuns:
  /** @param points the points, in the order of the links
    * @param printed each program's output: link, index of the run, text
    */
  final case class Flown(points: Vector[MarginPoint], printed: Vector[(String, Int, String)])

  /** The end of a run.
    *
    * @param printed what the program printed
    * @param isCut whether the run was ended early, so that its value means nothing
    */
  final case class Outcome(run: MarginRun, printed: String, isCut: Boolean)

  private def notRun(why: String): Outcome =
    Outcome(MarginRun(Left(MarginRun.NoResult.OfMachine(why)), 0, None, None), "", isCut = false)

  private final case class Run(link: Int, repeat: Int)
  private final case class Done(which: Run, ended: Outcome)
