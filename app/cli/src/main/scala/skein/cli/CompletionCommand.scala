package skein.cli

import mainargs.{Leftover, ParserForClass, arg}

/** Command-line options of `./skein completion`, with their help texts. */
final case class CompletionOptions(@arg(doc = "bash or zsh") shell: Leftover[String])

/** @param commands all commands of the program, including this one */
final class CompletionCommand(commands: => Seq[Command[?]])
    extends Command[CompletionOptions](
      "completion",
      "prints what a shell needs to complete commands and options",
      ParserForClass[CompletionOptions]
    ):

  protected def execute(options: CompletionOptions): Either[String, Unit] =
    (options.shell.value match
      case Seq("bash") => Right(Completion.bash("skein", commands))
      case Seq("zsh")  => Right(Completion.zsh("skein", commands))
      case other       =>
        val came = if other.isEmpty then "nothing" else other.mkString(" ")
        Left(s"expected one of ${Completion.Shells.mkString(", ")}, got $came")
    ).map(Console.out.println)
