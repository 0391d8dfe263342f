package skein.settings

import com.typesafe.config.{Config, ConfigException, ConfigFactory, ConfigParseOptions}

/** HOCON files that users name: configurations, policies, models. */
object HoconFile:

  /** Reads a file without resolving it.
    *
    * @return Left says why it cannot be read, in a line
    */
  def read(path: String): Either[String, Config] = TextFile.read(path).flatMap(parse(_, path))

  /** Parses a text.
    *
    * @param path path of the text's file, for error messages
    */
  def parse(text: String, path: String): Either[String, Config] =
    try Right(ConfigFactory.parseString(text, ConfigParseOptions.defaults.setOriginDescription(path)))
    catch
      case mistake: ConfigException => Left(ConfigMistakes.oneLine(mistake.getMessage))
      case _: StackOverflowError => Left(s"$path: its braces and brackets are nested too deeply to be read")
