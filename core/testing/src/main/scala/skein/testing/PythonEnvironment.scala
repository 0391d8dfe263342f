package skein.testing

import java.io.File
import java.nio.channels.FileChannel
import java.nio.file.StandardOpenOption.{CREATE, WRITE}
import java.nio.file.{FileSystems, Files, Path}
import munit.Assertions.assume
import scala.sys.process.{Process, ProcessLogger}
import scala.util.Using

/** A virtual Python environment with packages from PyPI, kept in the user's cache under a name that lists
  * their versions.
  *
  * @param imports modules that Python imports to check that the installation is complete
  * @param scripts a resource in the folder of the test scripts, if there are any
  * @param installs arguments of successive calls of `pip install`
  */
final class PythonEnvironment(imports: String, scripts: Option[String], installs: Seq[String]*):
  private lazy val resources = scripts.map(PythonEnvironment.folderOf)

  /** The environment's Python; skips the calling test if there is none. */
  def python(): Path =
    val made = install()
    assume(made.isRight, s"$imports cannot be installed here: ${made.left.getOrElse("")}")
    made.toOption.get

  /** The environment's Python, or why there is none. */
  def install(): Either[String, Path] =
    val cache =
      Option(System.getenv("XDG_CACHE_HOME")).fold(Path.of(sys.props("user.home"), ".cache"))(Path.of(_))
    val pinned = installs.flatten.filter(_.contains("=="))
    val home   = cache.resolve("skein").resolve(pinned.mkString("python-", "-", "").replace("==", "-"))
    val bin    = home.resolve("bin").resolve("python")
    val whole  = home.resolve("whole")
    def made =
      // Creating an environment with its own pip takes twice the time.
      val empty = ran("python3", "-m", "venv", "--clear", "--without-pip", home.toString)
      for
        _ <- installs.foldLeft(empty)((before, packages) => before.flatMap(_ => pip(bin, packages)))
        _ <- ran(bin.toString, "-c", s"import $imports")
      yield
        Files.createFile(whole): Unit
        bin
    Files.createDirectories(home.getParent)
    // Tests of several modules run concurrently, each in its own JVM.
    PythonEnvironment.synchronized:
      Using.resource(FileChannel.open(home.resolveSibling(s"${home.getFileName}.lock"), CREATE, WRITE)):
        channel =>
          Using.resource(channel.lock()): _ =>
            if Files.exists(whole) && Files.exists(bin) then Right(bin) else made

  /** Runs one of the scripts.
    *
    * @return its exit status, and its output
    */
  def run(script: String, arguments: String*): (Int, String) =
    val output  = StringBuilder()
    val command = Seq(python().toString, "-u", resources.get.resolve(script).toString) ++ arguments
    val status  = process(command).!(ProcessLogger(line => output.append(line).append('\n'): Unit))
    (status, output.toString)

  /** Installs packages without compiling their modules, because most are never imported. */
  private def pip(python: Path, packages: Seq[String]): Either[String, Unit] =
    ran(
      Seq("python3", "-m", "pip", "--python", python.toString, "install", "--quiet", "--no-compile") ++
        Seq("--disable-pip-version-check") ++ packages*
    )

  private def ran(command: String*): Either[String, Unit] =
    val output = StringBuilder()
    try
      val status = process(command).!(ProcessLogger(line => output.append(line).append('\n'): Unit))
      Either.cond(status == 0, (), s"${command.mkString(" ")}: ${output.toString.takeRight(500)}")
    catch case e: java.io.IOException => Left(e.getMessage)

  private def process(command: Seq[String]) =
    Process(command, Option.empty[File], resources.map("PYTHONPATH" -> _.toString).toSeq*)

object PythonEnvironment:

  /** The environment with AirSim's Python client.
    *
    * @param scripts see [[PythonEnvironment]]
    */
  def ofAirSim(scripts: Option[String] = None): PythonEnvironment = PythonEnvironment(
    imports = "airsim",
    scripts,
    Seq("setuptools", "wheel", "msgpack", "numpy"),
    // They are built with the packages already installed, because airsim's setup imports the client itself.
    Seq("--no-deps", "--no-build-isolation", "msgpack-rpc-python==0.4.1", "tornado==4.5.3"),
    Seq("--no-deps", "--no-build-isolation", "airsim==1.8.1")
  )

  /** Folder of a resource; a jar's content is extracted for the lifetime of this process. */
  private def folderOf(resource: String): Path =
    val found = getClass.getResource(resource).toURI
    if found.getScheme != "jar" then Path.of(found).getParent
    else
      Using.resource(FileSystems.newFileSystem(found, java.util.Map.of[String, String]())): jar =>
        val folder = Files.createTempDirectory("scripts")
        folder.toFile.deleteOnExit()
        Using.resource(Files.list(jar.getPath(resource).getParent)): files =>
          files.forEach: file =>
            val copy = Files.copy(file, folder.resolve(file.getFileName.toString))
            copy.toFile.deleteOnExit()
        folder
