package skein.cli

import mainargs.{ArgSig, ParserForClass, Result, Util}
import scala.annotation.unused
import skein.flight.NotFlown
import skein.record.{ClockKind, LoopKind}

/** A command of `./skein`: one file each.
  *
  * @param name the word after `./skein`
  * @param summary one line for `./skein --help`
  */
trait Command(val name: String, val summary: String):

  /** Runs with the words after the command's name.
    *
    * @return the exit status: 0 success; 1 failure, or something that cannot be done; 2 unknown options, or
    *   values of the wrong kind
    */
  def run(arguments: Seq[String]): Int

  /** Reads the words after the command's name without running it, for tests.
    *
    * @return or what is wrong with them
    */
  private[cli] def checked(arguments: Seq[String]): Either[String, Unit]

  /** What `--help` prints. */
  def help: String

  private[cli] def options: Seq[CommandOption]

/** What some options take, whatever command they belong to. */
private object OptionValues:
  val known: Map[String, Seq[String]] = Map(
    "loop"  -> LoopKind.values.map(_.label).toSeq,
    "clock" -> ClockKind.values.map(_.label).toSeq
  )

/** A command whose options are the fields of a case class.
  *
  * @tparam A the options; mainargs derives flags from the fields' names and help from their `@arg(doc = …)`
  */
abstract class OptionsCommand[A](name: String, summary: String, parser: ParserForClass[A])
    extends Command(name, summary):

  /** Does what the options say.
    *
    * @return or why it could not, in a line or more for a person
    */
  protected def execute(options: A): Either[String, Unit]

  final def help: String = help(100)

  /** @param width in columns
    */
  private[cli] def help(width: Int): String = HelpText.of(name, summary, operandsAndOptions, width)

  /** By options' names: what counts where one is not given and its own description does not tell. */
  protected def defaults: Map[String, String] = Map.empty

  /** By options' names: all values that one takes, where that is known. */
  protected def known: Map[String, Seq[String]] = Map.empty

  final def run(words: Seq[String]): Int =
    if words.takeWhile(_ != "--").exists(word => word == "--help" || word == "-h") then
      Console.out.println(help(Terminal.width.fold(100)(_.max(40).min(100))))
      0
    else
      parsed(words).fold(
        misused,
        options =>
          OutFolder.unlessRefused(done(options)) match
            case Right(())    => 0
            case Left(reason) =>
              Console.err.println(s"skein $name: ${Complaint.text(reason)}")
              1
      )

  private[cli] final def checked(words: Seq[String]): Either[String, Unit] =
    parsed(words).flatMap(check)

  /** Makes the settings that options state, without a file, a socket or a flight.
    *
    * @return or what is wrong with them
    */
  protected def check(@unused options: A): Either[String, Unit] = Right(())

  /** What stands behind `--` is another program's. */
  private def parsed(words: Seq[String]): Either[String, A] =
    val (arguments, behind) = words.span(_ != "--")
    val mistake = arguments.flatMap(Complaint.ofWord).headOption.orElse(strange(arguments).map(Misuse.noSuch(
      _,
      names
    )))
    mistake.toLeft(()).flatMap: _ =>
      parser.constructRaw(optionsFirst(arguments) ++ behind.drop(1)) match
        case failure: Result.Failure => Left(Misuse.text(failure, names))
        case Result.Success(options) => Right(options)

  private def misused(mistakes: String): Int =
    Complaint.text(mistakes).linesIterator.foreach(mistake => Console.err.println(s"skein $name: $mistake"))
    Console.err.println(s"skein $name: --help lists the options")
    2

  /** What looks like an option and is none, where mainargs would take it for a file. */
  private def strange(arguments: Seq[String]): Option[String] =
    if !parser.main.flattenedArgSigs.exists(_._2.isLeftover) then None
    else
      parted(arguments)
        .map(_.head)
        .find(word => word.startsWith("-") && word.length > 1 && !names.contains(word.takeWhile(_ != '=')))

  /** What the user can mend is bad input. */
  private def done(options: A): Either[String, Unit] =
    try execute(options)
    catch case error: Throwable => Left(NotFlown.mendable(error).getOrElse(throw error))

  /** `report FILE --out DIR` and `report --out DIR FILE` mean the same; mainargs takes everything behind the
    * first word without a dash for such words.
    */
  private def optionsFirst(arguments: Seq[String]): Seq[String] =
    val (options, files) = parted(arguments).partition(_.head.startsWith("-"))
    options.flatten ++ files.flatten

  /** Each option with its value, and each file. */
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
      name               <- argument.longName(Util.kebabCaseNameMapper)
    yield CommandOption(
      if reader.isLeftover then "" else s"--$name",
      argument.doc.getOrElse(""),
      Option.unless(reader.isFlag)(HelpText.placeholder(name, Misuse.kind(reader))),
      defaults.get(name).orElse(ownDefault(argument)),
      (OptionValues.known ++ known).getOrElse(name, Nil)
    )

  /** That of the options' case class. */
  private def ownDefault(argument: ArgSig): Option[String] =
    argument.default.map(_(parser.companion())).collect:
      case value: (String | Int | Long | Double) => value.toString

  private def takesValue(word: String): Boolean = parser.main.flattenedArgSigs.exists: (argument, reader) =>
    reader.isSimple && argument.longName(Util.kebabCaseNameMapper).exists(name => word == s"--$name")
