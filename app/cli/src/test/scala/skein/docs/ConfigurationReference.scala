package skein.docs

import com.typesafe.config.{ConfigFactory, ConfigObject, ConfigRenderOptions, ConfigValue}
import java.nio.file.Files
import scala.jdk.CollectionConverters.*
import skein.cli.OurScenarios
import skein.settings.ConfigKeys

/** All settings with their defaults as a page of the documentation: from `reference.conf` and its comments,
  * and from the scenarios and their docstrings.
  */
object ConfigurationReference:
  private val file = "fly/flight/src/main/resources/reference.conf"

  def markdown: String =
    val settings = ConfigFactory.parseFile(Documentation.root.resolve(file).toFile)
    val fly      = settings.getObject("skein.fly")
    val nested   = inOrder(fly).collect { case (name, inner: ConfigObject) => (name, inner) }
    Vector(
      introduction,
      table(fly),
      nested.map((name, inner) => s"## $name\n\n${comment(inner)}\n\n${table(inner)}").mkString("\n"),
      s"## Scenarios\n\n$scenariosComment\n\n$scenarios"
    ).mkString("\n")

  private val introduction =
    s"""# Configuration
       |
       |`./skein fly --config FILE` reads settings from a file in [HOCON](https://github.com/lightbend/config/blob/main/HOCON.md), a superset of JSON. Most settings are options of the command too, and an option counts before the file. What neither names has the default of this page, which is made from [reference.conf](../$file). A setting that does not exist is refused, with the nearest one that does.
       |
       |```
       |skein.fly {
       |  loops = [stream, predictive]
       |  links = ["lognormal:60ms,0.4"]
       |  planning { deadline = 40 ms }
       |}
       |```
       |
       |## skein.fly
       |""".stripMargin

  private val scenariosComment =
    "A scenario's settings stand under its name, for example `skein.fly { surround { ring-m = 10 } }`. " +
      "On the command line it is `--set ring-m=10`. `./skein scenarios` " +
      "lists them too, those of your own program among them."

  private def inOrder(of: ConfigObject): Vector[(String, ConfigValue)] =
    of.asScala.toVector.sortBy(_._2.origin.lineNumber)

  private def comment(of: ConfigValue): String =
    of.origin.comments.asScala.map(_.trim).mkString(" ").trim

  private def table(of: ConfigObject): String =
    val rows = inOrder(of).collect {
      case (name, value) if !value.isInstanceOf[ConfigObject] =>
        s"| `$name` | `${text(value)}` | ${comment(value).replace("|", "\\|")} |\n"
    }
    s"| setting | default | meaning |\n|---|---|---|\n${rows.mkString}"

  private def text(value: ConfigValue): String = value.unwrapped match
    case text: String => text
    case _            => value.render(ConfigRenderOptions.concise).replace("\"", "").replace(",", ", ")

  private def scenarios: String =
    OurScenarios.all.kinds.map: kind =>
      val docs = docstring(kind.standard.getClass.getSimpleName)
      val rows = kind.standard.settings.map: (name, value) =>
        s"| `${ConfigKeys.ofField(name)}` | `$value` | ${docs.parameter(name)} |\n"
      s"### ${kind.name}\n\n${docs.text}\n\n| setting | default | meaning |\n|---|---|---|\n${rows.mkString}"
    .mkString("\n")

  /** A scenario's docstring: of itself and of its settings. */
  private case class Docstring(text: String, parameters: Map[String, String]):
    def parameter(name: String): String =
      parameters.getOrElse(name, throw java.util.NoSuchElementException(s"no @param $name: $text"))

  private def docstring(scenario: String): Docstring =
    val source =
      Seq("core/core/src/main/scala/skein/scenario", "learn/recognition/src/main/scala/skein/recognition")
        .map(folder => Documentation.root.resolve(s"$folder/$scenario.scala"))
        .find(Files.exists(_))
        .fold(throw java.util.NoSuchElementException(s"no source of $scenario"))(Files.readString)
    val before  = source.take(source.indexOf(s"final case class $scenario("))
    val comment = before.substring(before.lastIndexOf("/**") + 3, before.lastIndexOf("*/"))
    val words   = comment.linesIterator.map(_.trim.stripPrefix("*").trim).mkString(" ").trim
    val parts   = words.split("@param ").toSeq.map(part => shown(part.trim))
    Docstring(
      parts.head,
      parts.tail.map(part => part.takeWhile(_ != ' ') -> part.dropWhile(_ != ' ').trim).toMap
    )

  /** The text without the brackets of links between definitions. */
  private def shown(text: String): String = """\[\[([^\]]*)\]\]""".r.replaceAllIn(text, "`$1`")
