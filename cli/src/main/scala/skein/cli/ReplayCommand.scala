package skein.cli

import java.nio.file.Path
import mainargs.{Leftover, ParserForClass, arg}
import skein.flight.{FlownAgain, Replayed}
import skein.record.Difference
import skein.scenario.Scenarios

/** Options of `./skein replay`. */
final case class ReplayOptions(
    @arg(doc = "recordings, for example flights/*.duckdb")
    files: Leftover[String]
)

final class ReplayCommand(using Scenarios)
    extends OptionsCommand[ReplayOptions](
      "replay",
      "decides again what a recording decided, and shows whether the same comes out",
      ParserForClass[ReplayOptions]
    ):

  protected def execute(options: ReplayOptions): Either[String, Unit] =
    for
      _ <- Either.cond(
        options.files.value.nonEmpty,
        (),
        "expected recordings, came none: ./skein replay FILE…"
      )
      same <- options.files.value.foldLeft[Either[String, Boolean]](Right(true)): (soFar, file) =>
        soFar.flatMap(same => replay(file).map(same && _))
      _ <- Either.cond(same, (), "not the same")
    yield ()

  private def replay(file: String): Either[String, Boolean] =
    Replayed
      .of(Path.of(file))
      .left
      .map(reason => s"$file: $reason")
      .map: replayed =>
        val lines = decisions("decided again on the recorded readings", replayed.decidedAgain, replayed)
          +: replayed.flownAgain.toSeq.flatMap(flown(_, replayed))
        lines.foreach(line => Console.out.println(s"${replayed.id}: $line"))
        replayed.isSame

  private def flown(again: FlownAgain, replayed: Replayed): Seq[String] =
    val contents =
      if again.isSame then s"SHA-256 of all that was recorded, both times: ${again.recorded}"
      else s"SHA-256 of all that was recorded: was ${again.recorded}, is ${again.again}"
    Seq(decisions("flown again in virtual time", again.inDecisions, replayed), contents)

  private def decisions(how: String, difference: Option[Difference], replayed: Replayed): String =
    difference match
      case None       => s"$how: ${replayed.decisions} decisions, all the same"
      case Some(here) => s"$how: the first of ${replayed.decisions} decisions to differ: ${here.message}"
