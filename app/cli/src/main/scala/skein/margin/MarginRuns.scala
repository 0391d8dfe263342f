package skein.margin

import java.util.concurrent.{Callable, Executors}
import skein.signal.{LatencyProfile, SplitMix64}
import skein.units.Decimals.brief

/** All runs of a margin, in turns over the links, so that a change of the machine's load affects all links
  * alike.
  *
  * @param atOnce maximum number of simultaneous runs
  * @param isStopped whether no further run begins
  * @param onEnded receives a line for each run that has ended
  */
final class MarginRuns(
    trial: MarginTrial,
    judge: MarginJudge,
    repeats: Int,
    atOnce: Int,
    seed: Long,
    isStopped: () => Boolean,
    onEnded: String => Unit
):
  import MarginRuns.*

  /** Executes all runs. Blocks.
    *
    * @param links the first one is the reference: if the program fails in its first run there, no other
    *   follows
    * @return Left says why there are none
    */
  def fly(links: Vector[LatencyProfile]): Either[String, Flown] =
    one(links, Run(0, 0)).flatMap: first =>
      first.run.value match
        case Left(MarginRun.NoResult.OfProgram(why)) if !isStopped() => Left(s"without a link: $why")
        case _                                                       =>
          val pool = Executors.newFixedThreadPool(atOnce, Thread.ofPlatform().daemon().factory())
          try
            val others =
              for
                repeat <- (0 until repeats).toVector
                link   <- links.indices if repeat > 0 || link > 0
              yield pool.submit((
                  () =>
                    Option.unless(isStopped())(one(links, Run(link, repeat)))
              ): Callable[Option[Either[String, Done]]])
            val (failed, done) = others.flatMap(_.get()).partitionMap(identity)
            failed.headOption.toLeft(flown(links, first +: done))
          finally pool.shutdown()

  private def one(links: Vector[LatencyProfile], which: Run): Either[String, Done] =
    val link = links(which.link)
    trial.run(link, SplitMix64.seedOf(seed, which.repeat * links.size + which.link), isStopped).map: ended =>
      val came = ended.run.value.fold(_.why, value => s"${judge.name} ${value.brief} ${judge.unit}".trim)
      if !isStopped() then onEnded(s"${link.name}, run ${which.repeat + 1} of $repeats: $came")
      Done(which, ended.run, ended.printed)

  private def flown(links: Vector[LatencyProfile], done: Vector[Done]) =
    // A run that was cut short is not counted.
    val whole = if isStopped() then done.filter(_.run.value.isRight) else done
    Flown(
      links.zipWithIndex.map((link, index) =>
        MarginPoint(link, whole.filter(_.which.link == index).map(_.run))
      ),
      done.map(one => (links(one.which.link).name, one.which.repeat + 1, one.printed))
    )

object MarginRuns:
  /** @param points the points, in the order of the links
    * @param printed each program's output: link, index of the run, text
    */
  final case class Flown(points: Vector[MarginPoint], printed: Vector[(String, Int, String)])

  private final case class Run(link: Int, repeat: Int)
  private final case class Done(which: Run, run: MarginRun, printed: String)
