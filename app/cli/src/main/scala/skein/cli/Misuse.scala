package skein.cli

import mainargs.{ArgSig, Result, TokensReader, Util}
import skein.scenario.Nearest

/** Describes mistakes in a command line, a line for each. */
private object Misuse:

  /** @param options the command's options, with their dashes */
  def text(failure: Result.Failure, options: Seq[String]): String = failure match
    case Result.Failure.MismatchedArguments(missing, unknown, duplicate, incomplete) =>
      // mainargs also reports everything after an unknown word as unknown.
      val all = missing.map(option => s"${name(option)}: expected, but not given") ++
        unknown.take(1).map(noSuch(_, options)) ++
        duplicate.map((option, words) =>
          s"${name(option)}: expected once, got ${words.mkString(" and ")}"
        ) ++
        incomplete.map(option => s"${name(option)}: expected a value behind it")
      all.mkString("\n")
    case Result.Failure.InvalidArguments(mistakes) => mistakes
        .map:
          case Result.ParamError.Failed(option, words, _)       => expected(option, words)
          case Result.ParamError.Exception(option, words, _)    => expected(option, words)
          case Result.ParamError.DefaultFailed(option, mistake) => s"${name(option)}: $mistake"
        .mkString("\n")
    case other => other.toString

  def noSuch(word: String, options: Seq[String]): String =
    val option = word.takeWhile(_ != '=')
    renamed.get(option).flatMap(_.find(options.contains)) match
      case Some(now) => s"$option: no such option any more; it is $now now"
      case None      =>
        val near =
          options.minByOption(Nearest.distance(option, _)).filter(Nearest.distance(option, _) <= MostWrong)
        s"$word: no such option or argument${near.fold("")(one => s"; the nearest is $one")}"

  /** Maximum number of differing letters for which a correction is suggested. */
  private val MostWrong = 2

  /** New names of renamed options: `--model` was both the predictor of flights and the plant of forward
    * simulation.
    */
  private val renamed = Map("--model" -> Seq("--predictor", "--plant"))

  private def expected(option: ArgSig, words: Seq[String]): String =
    val wanted = kind(option.reader) match
      case "int" | "long"     => "a whole number that is not too large"
      case "float" | "double" => "a number"
      case other              => s"a $other"
    s"${name(option)}: expected $wanted, got ${words.mkString("'", "' '", "'")}"

  /** The name of an option value's type in mainargs. */
  def kind(reader: TokensReader[?]): String = reader match
    case simple: TokensReader.ShortNamed[?] => simple.shortName
    case _                                  => "value"

  private def name(option: ArgSig): String =
    option.longName(Util.kebabCaseNameMapper).fold("the argument")(long => s"--$long")
