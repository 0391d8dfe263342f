package skein.cli

import java.nio.file.{Files, Path, StandardCopyOption}
import java.util.concurrent.TimeUnit
import scala.util.Try
import skein.docs.Documentation

/** Node, its packages and a browser, if this machine has them. */
object JavaScriptTools:
  private val scripts = Documentation.root.resolve("app/cli/src/test/js")

  /** The folder of the packages, or why there is none. */
  lazy val packages: Either[String, Path] =
    val folder = Files.createDirectories(Documentation.root.resolve("app/cli/target/js"))
    val named  = Seq("package.json", "package-lock.json")
    for name <- named do
      Files.copy(scripts.resolve(name), folder.resolve(name), StandardCopyOption.REPLACE_EXISTING): Unit
    val isThere =
      Seq("@bufbuild/protobuf", "@foxglove/ws-protocol", "ajv", "playwright-core", "ws").forall(name =>
        Files.isDirectory(folder.resolve("node_modules").resolve(name))
      )
    if isThere then Right(folder)
    else
      run(120, "npm", "ci", "--no-audit", "--no-fund", "--prefix", folder.toString).map(_ => folder).left.map(
        "npm cannot install the packages of app/cli/src/test/js: " + _
      )

  /** The path of Debian's browser, or that in the environment variable `CHROMIUM`. */
  lazy val browser: Either[String, String] =
    (sys.env.get("CHROMIUM").toSeq ++ Seq("/usr/bin/chromium", "/usr/bin/chromium-browser"))
      .find(path => Files.isExecutable(Path.of(path)))
      .toRight("there is no Chromium: install Debian's, or name one by CHROMIUM")

  def script(name: String): String = scripts.resolve(name).toString

  /** A program's output, or why it failed. Its standard input stays open while it runs. */
  def run(seconds: Int, command: String*): Either[String, String] =
    Try(start(command*)).toEither.left.map(_.getMessage).flatMap: process =>
      val output = String(process.getInputStream.readAllBytes())
      if !process.waitFor(seconds, TimeUnit.SECONDS) then process.destroyForcibly(): Unit
      Either.cond(process.waitFor() == 0, output, s"${command.head} ended with ${process.exitValue}: $output")

  def start(command: String*): Process =
    ProcessBuilder(command*).redirectError(ProcessBuilder.Redirect.INHERIT).start()
