import sbt.*
import sbt.Keys.*
import scala.xml.{Elem, Node, XML}
import scala.xml.transform.{RewriteRule, RuleTransformer}

object Publishing {

  /** Whether this sbt was started to publish. */
  val isWanted: Boolean = sys.props.getOrElse("sun.java.command", "").contains("publish")

  /** The release that `version` must be compatible with, if it does not begin a series. A series is all of `0.1`, or
    * all of `1`.
    */
  def previous(version: String): Option[String] =
    version.takeWhile(_ != '-').split('.').map(_.toInt) match {
      case Array(major, minor, patch) if patch > 0          => Some(s"$major.$minor.${patch - 1}")
      case Array(major, minor, _) if major > 0 && minor > 0 => Some(s"$major.${minor - 1}.0")
      case _                                                => None
    }

  /** A part, as it would be released. */
  private final case class Part(name: String, pom: Elem, classifiers: Set[String]) {

    /** What a repository or its users require and the part lacks. */
    def misses: Seq[String] = {
      val told = Seq(
        "description"         -> pom \ "description",
        "licence"             -> pom \ "licenses" \ "license" \ "url",
        "home page"           -> pom \ "url",
        "address of sources"  -> pom \ "scm" \ "url",
        "connection to them"  -> pom \ "scm" \ "connection",
        "developer"           -> pom \ "developers" \ "developer" \ "name"
      ).collect { case (what, found) if found.text.trim.isEmpty => what }
      told ++ (if (isWanted) Set("sources", "javadoc") -- classifiers else Nil)
    }
  }

  private val part = Def.taskDyn {
    if ((publish / skip).value) Def.task(Option.empty[Part])
    else
      Def.task(Option(Part(moduleName.value, XML.loadFile(makePom.value), artifacts.value.flatMap(_.classifier).toSet)))
  }

  /** These come with others: the agent with `vtime`, commands with a project that `./skein new` writes. */
  private val withOthers = Set("skein-vtime-agent", "skein-cli")

  /** Fails where a part lacks what a release needs, or is not built alone by `.ci/parts`. */
  val check: Def.Initialize[Task[Unit]] = Def.task {
    val parts = part.all(ScopeFilter(inAnyProject)).value.flatten
    val alone = IO.read((ThisBuild / baseDirectory).value / ".ci" / "parts")
    val mistakes =
      parts.flatMap(one => one.misses.map(what => s"${one.name} has no $what")) ++
        parts.map(_.name).filterNot(withOthers).filterNot { name =>
          alone.contains(s"""part("${name.stripPrefix("skein-")}"""")
        }.map(name => s".ci/parts does not build with $name alone")
    if (mistakes.nonEmpty) sys.error(mistakes.mkString("\n", "\n", ""))
    val archives = if (isWanted) "" else ", archives aside: those are made by an sbt that was started to publish"
    streams.value.log.info(s"${parts.size} parts have all that a release needs$archives")
  }

  /** A part's description without what its tests need: some of it is published nowhere. */
  def withoutTests(pom: Node): Node = new RuleTransformer(new RewriteRule {
    override def transform(node: Node): Seq[Node] = node match {
      case one: Elem if one.label == "dependency" && (one \ "scope").text == "test" => Nil
      case other                                                                    => other
    }
  }).transform(pom).head
}
