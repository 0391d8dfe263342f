package skein.mcap

import java.io.{File, IOException}
import java.nio.file.{Files, Path}
import scala.sys.process.{Process, ProcessLogger}

/** The official library in a virtual environment of its own, kept in the user's cache under the versions' names. */
object OfficialPythonLibrary:
  private val packages  = Seq("mcap==1.6.0", "zstandard==0.25.0", "lz4==4.4.5")
  private val resources = Path.of(getClass.getResource("/mcap-python/read.py").toURI).getParent

  /** The environment's Python, or why there is none. */
  def install(): Either[String, Path] =
    val cache =
      Option(System.getenv("XDG_CACHE_HOME")).fold(Path.of(sys.props("user.home"), ".cache"))(Path.of(_))
    val home = cache.resolve("skein").resolve(packages.mkString("python-", "-", "").replace("==", "-"))
    val bin  = home.resolve("bin").resolve("python")
    if imports(bin) then Right(bin)
    else
      for
        _ <- ran("python3", "-m", "venv", "--clear", home.toString)
        _ <- ran(
          Seq(bin.toString, "-m", "pip", "install", "--quiet", "--disable-pip-version-check") ++ packages*
        )
        _ <- Either.cond(imports(bin), (), "it is installed but cannot be imported")
      yield bin

  /** What a script says last; of one that fails, everything. */
  def run(python: Path, script: String, folder: Path): String =
    ran(python.toString, "-u", resources.resolve(script).toString, folder.toString)
      .fold(identity, _.linesIterator.toSeq.lastOption.getOrElse(""))

  private def imports(python: Path): Boolean =
    Files.exists(python) && ran(python.toString, "-c", "import mcap.reader, zstandard, lz4.frame").isRight

  private def ran(command: String*): Either[String, String] =
    val output = StringBuilder()
    try
      val status = Process(command, Option.empty[File]).!(
        ProcessLogger(line => output.append(line).append('\n'): Unit)
      )
      Either.cond(
        status == 0,
        output.toString,
        s"${command.mkString(" ")}: ${output.toString.takeRight(2000)}"
      )
    catch case e: IOException => Left(e.getMessage)
