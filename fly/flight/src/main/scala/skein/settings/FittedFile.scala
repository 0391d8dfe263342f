package skein.settings

import com.typesafe.config.{Config, ConfigException, ConfigUtil}
import skein.identify.Fitted
import skein.units.Expect

/** The common format of files with fitted parameters. */
private object FittedFile:

  /** A parameter with its interval; a remark says if it is not identified. */
  def line(parameter: Fitted, atBound: String): String =
    import parameter.{least, most, name, value}
    val remark = if parameter.atBound then s"  # $atBound" else ""
    s"$name { value = ${number(value)}, least = ${number(least)}, most = ${number(most)} }$remark"

  def list(name: String, texts: Vector[String]): String =
    texts.map(text => s"    ${ConfigUtil.quoteString(text)}").mkString(s"  $name = [\n", "\n", "\n  ]")

  /** Formats a number with six significant digits. */
  def number(value: Double): String =
    BigDecimal(value).round(java.math.MathContext(6)).bigDecimal.stripTrailingZeros.toPlainString

  /** Reads a file's section.
    *
    * @param what the expected kind of file, in words
    * @return Left says what is wrong
    */
  def parse[A](text: String, path: String, section: String, what: String)(
      read: Config => Either[String, A]
  ): Either[String, A] =
    val fitted =
      try HoconFile.parse(text, path).flatMap(file => read(file.resolve().getConfig(section)))
      catch
        case wrong: ConfigException          => Left(s"$path is no $what: ${wrong.getMessage}")
        case wrong: IllegalArgumentException => Left(s"$path: ${Expect.refused(wrong)}")
    fitted.left.map(ConfigMistakes.oneLine)
