package skein

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.matching.Regex

/** The dependencies of source files, by names: which file uses which other. It reads words, not trees: a file
  * uses a top-level definition if the definition's name occurs in it, and is in the file's own package, is
  * imported, or is qualified. A local definition of an equal name can add a false dependency.
  */
final case class House(sources: Vector[House.Source]):
  import House.*

  private val byName: Map[(String, String), Vector[Source]] =
    (for source <- sources; name <- source.defined yield (source.room, name) -> source)
      .groupMap(_._1)(_._2)

  private val namesOf: Map[String, Set[String]] =
    byName.keys.toVector.groupMap(_._1)(_._2).map((k, v) => k -> v.toSet)

  val uses: Map[Source, Set[Source]] = sources.map(source => source -> usedBy(source)).toMap

  private def usedBy(source: Source): Set[Source] =
    val own      = namesOf.getOrElse(source.room, Set.empty).map(name => name -> (source.room, name))
    val imported = source.imports.flatMap:
      case (room, "*")  => namesOf.getOrElse(room, Set.empty).map(name => name -> (room, name))
      case (room, name) => Set(name -> (room, name))
    val visible = own.toMap ++ imported
    val said    = source.words.flatMap(visible.get) ++ source.qualified
    said.flatMap(byName.getOrElse(_, Vector.empty)).filterNot(_ == source)

  /** The folder of the root that contains a file. */
  def room(root: Path, source: Source): String = root.relativize(source.path).getName(0).toString

  /** Cycles of files that use one another, largest first. */
  def circles: Vector[Vector[Source]] =
    val reached = sources.map(source => source -> reachedFrom(source)).toMap
    sources
      .map(source => reached(source).filter(reached(_)(source)).toVector.sortBy(_.path.toString))
      .filter(_.nonEmpty)
      .distinct
      .sortBy(-_.size)

  private def reachedFrom(source: Source): Set[Source] =
    var seen = Set.empty[Source]
    var next = uses(source)
    while next.nonEmpty do
      seen ++= next
      next = next.flatMap(uses) -- seen
    seen

object House:

  /** @param room the file's package
    * @param defined top-level names
    * @param imports our imported definitions: package and name, or `*`
    * @param qualified names used with their package
    */
  final case class Source(
      path: Path,
      module: String,
      room: String,
      defined: Set[String],
      imports: Set[(String, String)],
      qualified: Set[(String, String)],
      words: Set[String]
  ):
    override def toString: String   = s"$module/$room/${path.getFileName}"
    override def equals(any: Any)   = any match { case s: Source => s.path == path; case _ => false }
    override def hashCode           = path.hashCode
    def says(word: String): Boolean = Files.readString(path).contains(word)

  /** All main sources below a folder. */
  def under(root: Path): House =
    def inside(folder: Path) = Files.list(folder).iterator.asScala.filter(Files.isDirectory(_)).toVector
    val rooms                = inside(root).filterNot(folder => noRooms(folder.getFileName.toString))
    val folders              = rooms.flatMap(room => room +: inside(room))
    House(
      for
        folder <- folders
        main = folder.resolve("src/main") if Files.isDirectory(main)
        path <- Files.walk(main).iterator.asScala if isSource(path)
      yield read(
        path,
        if folder.getParent.endsWith("bench") then s"bench-${folder.getFileName}"
        else folder.getFileName.toString
      )
    )

  private val noRooms = Set("docs", "examples", "project", "target")

  private def isSource(path: Path) = path.toString.endsWith(".scala") || path.toString.endsWith(".java")

  private val comments = """(?s)/\*.*?\*/|//[^\n]*""".r
  private val blocks   = "(?s)\"\"\".*?\"\"\"".r
  private val strings  = """"(?:\\.|[^"\\\n])*"""".r
  private val spliced  = """\$\{([^}]*)\}""".r

  /** The code without comments and string literals, but with interpolated expressions. */
  private def code(text: String): String =
    val uncommented = blocks.replaceAllIn(comments.replaceAllIn(text, ""), Regex.quoteReplacement("\"\""))
    strings.replaceAllIn(
      uncommented,
      found =>
        Regex.quoteReplacement(s"\"\" ${spliced.findAllMatchIn(found.matched).map(_.group(1)).mkString(" ")}")
    )

  private val importLine = """(?m)^\s*import (?:static )?(skein(?:\.[a-z]\w*)*)\.(\{[^}]*\}|\*|\w+)""".r
  private val mention    = """\b(skein(?:\.[a-z]\w*)+)\.([A-Z]\w*)""".r
  private val word       = """[A-Za-z_]\w*""".r
  private val definition =
    ("""(?m)^(?:@\w+\s+)?(?:(?:private|protected|public|final|sealed|non-sealed|abstract|case|open|opaque|inline|transparent|""" +
      """lazy)(?:\[\w+\])? )*(?:class|object|trait|enum|type|def|val|given|interface|record) ([A-Za-z_]\w*)""").r

  private def read(path: Path, module: String): Source =
    val text    = code(Files.readString(path))
    val room    = """(?m)^package ([\w.]+)""".r.findFirstMatchIn(text).fold("")(_.group(1))
    val body    = text.linesIterator.filterNot(_.trim.startsWith("import ")).mkString("\n")
    val imports = importLine.findAllMatchIn(text).flatMap: found =>
      found.group(2).stripPrefix(
        "{"
      ).stripSuffix("}").split(',').map(_.trim.split(" as ")(0).trim).map(found.group(1) -> _)
    Source(
      path,
      module,
      room,
      definition.findAllMatchIn(text).map(_.group(1)).toSet,
      imports.toSet,
      mention.findAllMatchIn(text).map(found => found.group(1) -> found.group(2)).toSet,
      word.findAllIn(body).toSet
    )
