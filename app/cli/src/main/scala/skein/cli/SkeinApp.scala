package skein.cli

import java.io.{FileDescriptor, FileOutputStream, IOException, OutputStream, PrintStream}
import java.nio.file.InvalidPathException
import java.util.Locale
import java.util.concurrent.TimeoutException
import org.slf4j.LoggerFactory
import skein.forecast.Structure
import skein.loop.OwnLoop
import skein.policy.PolicyFamily
import skein.scenario.{ScenarioKind, Scenarios}

/** A program with all of Skein's commands, for scenarios of your own:
  *
  * {{{
  * object Patrol extends SkeinApp(ScenarioKind(OverTheRidge()))
  * }}}
  *
  * @param kinds the kinds of scenarios, at least one; the first is the default
  */
open class SkeinApp(kinds: ScenarioKind[?]*):
  // First of all: numbers, dates and the libraries' treatment of letters must not depend on the machine's
  // locale.
  Locale.setDefault(Locale.ROOT)
  Terminal.adapt()

  /** Your own families of policies, for the duel's roles: `search`, `budget`, policy files, `--opponent` and
    * `--fallback` accept their names. Read before the object's own fields are initialised, so it must not
    * refer to them.
    */
  def policyFamilies: Seq[PolicyFamily] = Nil

  /** Your own structures of plants: `identify` fits them, and `--plant FILE` and `--predictor FILE` accept
    * them. Read as early as [[policyFamilies]].
    */
  def structures: Seq[Structure] = Nil

  /** Your own loops: `fly` and `spread` run them by `--loop`, and `report` and `replay` accept them. Read as
    * early as [[policyFamilies]].
    */
  def loops: Seq[OwnLoop] = Nil

  final given scenarios: Scenarios =
    Scenarios(kinds.toVector, policyFamilies.toVector, structures.toVector, loops.toVector)

  private def program = getClass.getName.stripSuffix("$")

  /** The commands by purpose, as `--help` lists them. */
  private val groups: Seq[(String, Seq[Command[?]])] = Seq(
    "Fly" -> Seq(
      FlyCommand(),
      SpreadCommand(program),
      TortureCommand(program),
      BenchmarkCommand(),
      ScenariosCommand(),
      NewCommand
    ),
    "Choose a policy before the flight" -> Seq(
      SearchCommand(program),
      LearnCommand(program),
      BudgetCommand(program),
      PolicyCommand()
    ),
    "Simulator and network"       -> Seq(ServeCommand, LinkCommand, LinkFitCommand, LatencyCommand),
    "Judge a program of your own" -> Seq(ObserveCommand, MarginCommand()),
    "Work with recordings"        -> Seq(
      ReportCommand(),
      ReplayCommand(),
      IdentifyCommand(),
      ExportCommand,
      ImportCommand,
      DigestCommand
    ),
    "Other processes and machines" -> Seq(DecideCommand(), WorkerCommand(), ClusterCommand),
    "Shell"                        -> Seq(CompletionCommand(commands))
  )

  private[skein] final val commands: Seq[Command[?]] = groups.flatMap(_._2)

  final def main(arguments: Array[String]): Unit =
    val status = Edge.tellingExit(run(arguments.toSeq))
    if !Edge.isInterrupted then
      sys.exit(if status == 0 then written(System.out, FileOutputStream(FileDescriptor.out)) else status)

  /** Flushes the outputs; a reader that has closed its pipe early is not a failure. */
  private[skein] final def written(out: PrintStream, again: OutputStream): Int =
    val why = Option.when(out.checkError()):
      try
        again.write('\n')
        again.flush()
        "some of it was lost"
      catch case failed: IOException => s"${failed.getMessage}"
    why
      .filterNot(_.contains("Broken pipe"))
      .fold(0): reason =>
        Console.err.println(s"skein: cannot write to standard output: $reason")
        1

  /** Runs one command, for tests.
    *
    * @return the exit status: 0 success; 1 failure, or a request that cannot be fulfilled; 2 unknown options,
    *   or values of the wrong kind
    */
  final def run(arguments: Seq[String]): Int =
    arguments.headOption match
      case None | Some("--help" | "-h" | "help") =>
        Console.out.println(help)
        0
      case Some("--version") =>
        Console.out.println(s"Skein ${NewCommand.resource("version")}, Java ${sys.props("java.version")}")
        0
      case Some(word) =>
        commands.find(_.name == word) match
          case Some(command) =>
            // Set up before several threads of a command need it simultaneously, which it would log.
            val _ = LoggerFactory.getILoggerFactory
            try command.run(arguments.tail)
            catch
              case mistake: InvalidPathException =>
                Console.err.println(s"skein $word: ${Complaint.text(wrongName(mistake))}")
                1
              case error: Throwable => unexpected(word, error)
          case None =>
            Console.err.println(
              Complaint.text(
                s"skein: no command '${word.filterNot(_.isControl)}'. There are: ${commands.map(_.name).mkString(", ")}."
              )
            )
            2

  /** Reports an unexpected exception, after all other threads have printed their lines.
    *
    * @return an exit status of its own
    */
  private[skein] final def unexpected(word: String, error: Throwable): Int =
    error match
      // Only waits at the start have such a limit.
      case late: TimeoutException =>
        val why = s"this machine has too much else to do: ${late.getMessage}"
        Console.err.println(s"skein $word: given up before it began, for $why")
      case _ =>
        error.printStackTrace(Console.err)
        Console.err.println(s"skein $word: ended by an error that nothing expected: $error")
    1

  /** Explains names that Java cannot decode because the locale is ASCII. */
  private def wrongName(mistake: InvalidPathException): String =
    if mistake.getReason.contains("unmappable") then
      s"the locale's letters, ${sys.props("sun.jnu.encoding")}, cannot encode a file's name, " +
        s"got '${mistake.getInput}'; a locale with UTF-8, such as LC_ALL=C.UTF-8, can"
    else s"expected the name of a file or folder, got '${mistake.getInput}': ${mistake.getReason}"

  private def help: String =
    val width = commands.map(_.name.length).maxOption.getOrElse(0)
    val lines = groups.map: (purpose, commands) =>
      commands
        .map(command => s"  ${command.name.padTo(width, ' ')}  ${command.summary}")
        .mkString(s"$purpose:\n", "\n", "")
    s"""Skein: control graphs for teams of drones that know how old their data is.
       |
       |Usage: ./skein COMMAND [OPTION…]
       |
       |${lines.mkString("\n\n")}
       |
       |./skein COMMAND --help lists a command's options; ./skein --version prints the version.""".stripMargin
