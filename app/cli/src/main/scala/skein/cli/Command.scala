package skein.cli

import mainargs.{ArgSig, Leftover, ParserForClass, Result, Util}
import scala.annotation.unused
import skein.flight.NotFlown
import skein.record.{ClockKind, LoopKind}
import skein.scenario.ScenarioText
import skein.settings.ScenarioSettings
import skein.units.Expect

private object Command:
  val Scenario = "--scenario"

  def scenario(word: String): Either[String, List[String]] =
    ScenarioSettings.named(word).left.map(s"$Scenario: " + _).map(List(Scenario, _))

/** Values of options that several commands share. */
private object OptionValues:
  val known: Map[String, Seq[String]] = Map(
    "loop"  -> LoopKind.values.map(_.label).toSeq,
    "clock" -> ClockKind.values.map(_.label).toSeq
  )

/** A command of `./skein`; each has a file of its own.
  *
  * @tparam A the options, fields of a case class; mainargs derives flags from the fields' names and help from
  *   their `@arg(doc = …)`
  * @param name the word after `./skein`
  * @param summary one line for `./skein --help`
  */
abstract class Command[A](val name: String, val summary: String, parser: ParserForClass[A]):

  /** Executes the command.
    *
    * @return Left says why it failed, in one or more lines for a person
    */
  protected def execute(options: A): Either[String, Unit]

  final def help: String = help(100)

  private[cli] def help(width: Int): String = HelpText.of(name, summary, operandsAndOptions, width)

  /** Defaults by option name, for options whose own description does not state one. */
  protected def defaults: Map[String, String] = Map.empty

  /** Names of options that it shares with another command but refuses; help and completion omit them. */
  protected def refusedAlways: Set[String] = Set.empty

  /** Whether the text of a scenario's file replaces its path before the options are read. */
  protected def readsScenario: Boolean = true

  /** All values of an option, by option name, if the set is known. */
  protected def known: Map[String, Seq[String]] = Map.empty

  /** Runs with the words after the command's name.
    *
    * @return the exit status: 0 success; 1 failure, or a request that cannot be fulfilled; 2 unknown options,
    *   or values of the wrong kind
    */
  final def run(words: Seq[String]): Int =
    if words.takeWhile(_ != "--").exists(word => word == "--help" || word == "-h") then
      Console.out.println(help(Terminal.width.fold(100)(_.max(40).min(100))))
      0
    else
      scenarioRead(words).fold(
        refused,
        parsed(_).fold(
          misused,
          options => OutFolder.unlessRefused(done(options)).fold(refused, _ => 0)
        )
      )

  private def refused(reason: String): Int =
    Console.err.println(s"skein $name: ${Complaint.text(reason)}")
    1

  /** Reads the words after the command's name without running it, for tests.
    *
    * @return Left says what is wrong with them
    */
  private[cli] final def checked(words: Seq[String]): Either[String, Unit] =
    scenarioRead(words).flatMap(parsed).flatMap(check)

  /** Replaces the path of a scenario's file by the file's text. */
  private def scenarioRead(words: Seq[String]): Either[String, Seq[String]] =
    if !readsScenario || !names.contains(Command.Scenario) then Right(words)
    else
      val (arguments, behind) = words.span(_ != "--")
      Expect
        .each(parted(arguments)):
          case List(Command.Scenario, word)       => Command.scenario(word)
          case List(s"${Command.Scenario}=$word") => Command.scenario(word)
          case other                              => Right(other)
        .map(_.flatten ++ behind)

  /** Makes the settings of the options, without a file, a socket or a flight.
    *
    * @return Left says what is wrong with them
    */
  protected def check(@unused options: A): Either[String, Unit] = Right(())

  /** Parses the words before `--`; the words after it belong to another program. */
  private def parsed(words: Seq[String]): Either[String, A] =
    val (arguments, behind) = words.span(_ != "--")
    val mistake = arguments.filterNot(ScenarioText.isText).flatMap(Complaint.ofWord).headOption.orElse(
      strange(arguments).map(Misuse.noSuch(
        _,
        names
      ))
    )
    mistake.toLeft(()).flatMap: _ =>
      val others = behind.drop(1)
      val words  = if startsProgram then others.map(Behind.marked) else others
      parser.constructRaw(optionsFirst(arguments) ++ words) match
        case failure: Result.Failure => Left(Misuse.text(failure, names))
        case Result.Success(options) => Right(options)

  /** The only word of a command that takes one.
    *
    * @param what it is, for people
    */
  protected def only(words: Leftover[String], what: String, usage: String): Either[String, String] =
    words.value match
      case Seq(one) => Right(one)
      case others   => Left(s"expected one $what, got ${others.size}: $usage")

  private def startsProgram = parser.main.flattenedArgSigs.exists(_._2 == Behind.Reader)

  private def misused(mistakes: String): Int =
    Complaint.text(mistakes).linesIterator.foreach(mistake => Console.err.println(s"skein $name: $mistake"))
    Console.err.println(s"skein $name: --help lists the options")
    2

  /** The first unknown option among the words, which mainargs would take for a file name. */
  private def strange(arguments: Seq[String]): Option[String] =
    if !parser.main.flattenedArgSigs.exists(_._2.isLeftover) then None
    else
      parted(arguments)
        .map(_.head)
        .find(word => word.startsWith("-") && word.length > 1 && !names.contains(word.takeWhile(_ != '=')))

  /** Executes; a mistake that the user can correct becomes an error message. */
  private def done(options: A): Either[String, Unit] =
    try execute(options)
    catch case error: Throwable => Left(NotFlown.mendable(error).getOrElse(throw error))

  /** Moves options before files: `report FILE --out DIR` and `report --out DIR FILE` are equivalent, but
    * mainargs treats everything after the first file as files.
    */
  private def optionsFirst(arguments: Seq[String]): Seq[String] =
    val (options, files) = parted(arguments).partition(_.head.startsWith("-"))
    options.flatten ++ files.flatten

  /** Splits the words into options with their values, and files. */
  private def parted(arguments: Seq[String]): Seq[List[String]] = Iterator
    .unfold(arguments.toList):
      case word :: value :: rest if takesValue(word) => Some((List(word, value), rest))
      case word :: rest                              => Some((List(word), rest))
      case Nil                                       => None
    .toSeq

  private def names: Seq[String] =
    parser.main.flattenedArgSigs.flatMap((argument, _) => argument.longName(Util.kebabCaseNameMapper)).map(
      "--" + _
    )

  private[cli] final def options: Seq[CommandOption] = operandsAndOptions.filter(_.flag.nonEmpty)

  private def operandsAndOptions: Seq[CommandOption] =
    for
      (argument, reader) <- parser.main.flattenedArgSigs
      name               <- argument.longName(Util.kebabCaseNameMapper) if !refusedAlways(name)
    yield CommandOption(
      if reader.isLeftover then "" else s"--$name",
      argument.doc.getOrElse(""),
      Option.unless(reader.isFlag)(HelpText.placeholder(name, Misuse.kind(reader))),
      defaults.get(name).orElse(ownDefault(argument)),
      (OptionValues.known ++ known).getOrElse(name, Nil)
    )

  /** The default that the options' case class declares. */
  private def ownDefault(argument: ArgSig): Option[String] =
    argument.default.map(_(parser.companion())).collect:
      case value: (String | Int | Long | Double) => value.toString

  private def takesValue(word: String): Boolean = parser.main.flattenedArgSigs.exists: (argument, reader) =>
    reader.isSimple && argument.longName(Util.kebabCaseNameMapper).exists(name => word == s"--$name")
