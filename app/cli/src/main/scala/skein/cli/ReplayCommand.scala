package skein.cli

import java.nio.file.Path
import mainargs.{Leftover, ParserForClass, arg}
import scala.concurrent.Promise
import skein.flight.{FlownAgain, Replayed}
import skein.record.{Difference, RecordingReader}
import skein.scenario.Scenarios
import skein.units.Expect
import skein.view.{RecordedShow, Shows}

/** Command-line options of `./skein replay`, with their help texts. */
final case class ReplayOptions(
    view: ViewOptions,
    @arg(doc = "recordings, for example flights/*.duckdb")
    files: Leftover[String]
)

/** `./skein replay`: recomputes the decisions of a recording and compares them, or plays it with `--view`. */
final class ReplayCommand(using Scenarios)
    extends Command[ReplayOptions](
      "replay",
      "repeats the decisions of a recording and compares them; with --view, plays it",
      ParserForClass[ReplayOptions]
    ):

  protected def execute(options: ReplayOptions): Either[String, Unit] =
    for
      _ <- Expect.that(options.files.value.nonEmpty)("expected recordings, got none: ./skein replay FILE…")
      _ <- options.view.mistake.toLeft(())
      _ <- if options.view.view.value then play(options) else replayAll(options.files.value)
    yield ()

  /** Plays recordings in the viewer, until Ctrl-C. */
  private def play(options: ReplayOptions): Either[String, Unit] =
    val shows = Shows()
    for
      _ <- Expect.each(options.files.value): file =>
        for rows <- RecordingReader.records(Path.of(file)).left.map(_.message)
        yield shows.add(RecordedShow.of(rows, RecordOptions.sceneOf))
      _ <- options.view.serving(shows):
        val ended = Promise[Either[String, Unit]]()
        Console.err.println("Ctrl-C ends it")
        Edge.untilInterrupted(() => ended.trySuccess(Right(())): Unit)(Edge.await(ended.future))
    yield ()

  private def replayAll(files: Seq[String]): Either[String, Unit] =
    Expect.all(files)(replay).map(_ => ())

  /** @return Left says what differs, or why it could not be replayed */
  private def replay(file: String): Either[String, Unit] =
    for
      replayed <- Replayed.of(Path.of(file)).left.map(reason =>
        if reason.contains(file) then reason else s"$file: $reason"
      )
      lines = decisions("decided again on the recorded readings", replayed.decidedAgain, replayed)
        +: replayed.flownAgain.toSeq.flatMap(flown(_, replayed))
      _ = lines.foreach(line => Console.out.println(s"$file: ${replayed.id}: $line"))
      _ <- replayed.notFlownAgain.map(why => s"$file: not flown again: $why").toLeft(())
      _ <- Expect.that(replayed.isSame)(s"$file: not the same")
    yield ()

  private def flown(again: FlownAgain, replayed: Replayed): Seq[String] =
    val contents =
      if again.isSame then s"SHA-256 of all that was recorded, both times: ${again.recorded}"
      else s"SHA-256 of all that was recorded: was ${again.recorded}, is ${again.again}"
    Seq(decisions("flown again in virtual time", again.inDecisions, replayed), contents)

  private def decisions(how: String, difference: Option[Difference], replayed: Replayed): String =
    difference match
      case None       => s"$how: ${replayed.decisions} decisions, all the same"
      case Some(here) => s"$how: the first of ${replayed.decisions} decisions to differ: ${here.message}"
