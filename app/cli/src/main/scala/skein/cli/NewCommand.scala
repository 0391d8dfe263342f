package skein.cli

import java.io.IOException
import java.nio.file.attribute.PosixFilePermissions
import java.nio.file.{FileSystems, Files, Path}
import java.util.Comparator
import mainargs.{Leftover, ParserForClass, arg}
import scala.util.Using
import skein.record.FileReason
import skein.report.Typed
import skein.scenario.ScenarioNames
import skein.units.Expect

/** Command-line options of `./skein new`, with their help texts. */
final case class NewOptions(
    @arg(doc = "folder to create; without it, ./NAME")
    out: Option[String],
    @arg(doc = "name of the project: small letters, digits and dashes, for example ridge-watch")
    name: Leftover[String]
)

/** `./skein new`: writes a project with a scenario, a test and all commands. */
object NewCommand
    extends Command[NewOptions](
      "new",
      "writes a project for a scenario of your own: build, policy, test, all commands",
      ParserForClass[NewOptions]
    ):

  protected def execute(options: NewOptions): Either[String, Unit] =
    for
      name <- only(options.name, "name", "./skein new NAME")
      _    <- Expect.that(name.matches("[a-z][a-z0-9]*(-[a-z][a-z0-9]*)*")):
        s"expected words of small letters and digits, joined by dashes, each begun by a letter, got '$name'"
      _ <- taken(name).toLeft(())
      folder = Path.of(options.out.getOrElse(name))
      _ <-
        Expect.that(!Files.exists(folder))(s"expected a folder that is not there yet, got '$folder'")
      _ <- OutFolder.made("--out", folder.toString)
      _ <- write(folder, name)
    yield
      Console.out.println(s"written: $folder")
      Console.out.println(s"fly it: cd ${Typed.path(folder)} && ./skein fly --clock virtual")
      Console.out.println("It builds from what ./sbtw installLocal has put on this machine.")

  private def className(name: String)   = name.split('-').map(_.capitalize).mkString
  private def packageName(name: String) = name.replace("-", "")

  /** Why a project of this name would not compile, because its sources already use its package's or class's
    * name, or its scenario would not fly.
    */
  private def taken(name: String): Option[String] =
    val sources = Seq("Scenario.scala.txt", "Suite.scala.txt").map(resource).mkString("\n")
    // Ignores members of other names, and string literals.
    val isUsed = s"""(?<![.\"\\w])${className(name)}\\b""".r.findFirstIn(sources).isDefined
    Option
      .when(isUsed || Reserved(packageName(name)))(
        s"expected a name that means nothing else in Scala, got '$name'"
      )
      .orElse(ScenarioNames.mistake(name))
      .map(why => s"$why; for example $name-flight")

  /** Scala's keywords, and packages that the sources need. */
  private val Reserved =
    ("abstract case catch class def do else enum export extends false final finally " +
      "for given if implicit import lazy match new null object override package " +
      "private protected return sealed super then this throw trait true try " +
      "type val var while with yield java javax munit sbt scala skein").split(' ').toSet

  private def write(folder: Path, name: String): Either[String, Unit] =
    val words  = className(name)
    val filled = Map(
      "@NAME@"    -> name,
      "@PACKAGE@" -> packageName(name),
      "@CLASS@"   -> words,
      "@VERSION@" -> resource("version"),
      "@SCALA@"   -> resource("scala-version")
    )
    val source = s"src/main/scala/${filled("@PACKAGE@")}/$words.scala"
    val suite  = s"src/test/scala/${filled("@PACKAGE@")}/${words}Suite.scala"
    val files  = Seq(
      "build.sbt"          -> "build.sbt",
      "build.properties"   -> "project/build.properties",
      "find-jdk"           -> "project/find-jdk",
      "quiet-vectors"      -> "project/quiet-vectors",
      "sbtw"               -> "sbtw",
      "skein"              -> "skein",
      "gitignore"          -> ".gitignore",
      "README.md.txt"      -> "README.md",
      "Scenario.scala.txt" -> source,
      "Suite.scala.txt"    -> suite
    )
    try
      for (from, to) <- files do
        val file = folder.resolve(to)
        val text = filled.foldLeft(resource(from)) { case (text, (mark, value)) => text.replace(mark, value) }
        Files.createDirectories(file.getParent)
        Files.writeString(file, text)
        if executable(to) && FileSystems.getDefault.supportedFileAttributeViews.contains("posix") then
          val _ = Files.setPosixFilePermissions(file, PosixFilePermissions.fromString("rwxr-xr-x"))
      Right(())
    catch
      case failed: IOException =>
        emptied(folder)
        Left(s"cannot write into the folder $folder: ${FileReason.of(failed)}")

  /** Deletes a partially written project, which would block the next attempt. */
  private def emptied(folder: Path): Unit =
    try
      Using.resource(Files.walk(folder)): all =>
        all.sorted(Comparator.reverseOrder()).filter(_ != folder).forEach(Files.delete(_))
    catch case _: IOException => ()

  private val executable = Set("sbtw", "skein")

  /** A resource of the distribution: its version, or a file of the project template. */
  private[cli] def resource(name: String): String =
    Using.resource(getClass.getResourceAsStream(s"/skein/project/$name"))(stream =>
      String(stream.readAllBytes, "UTF-8")
    )
