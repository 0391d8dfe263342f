import sbt.*
import scala.sys.process.{Process, ProcessLogger}

/** The Python package as one file: `./sbtw python/wheel`. */
object Wheel {
  val wheel: TaskKey[File] = taskKey[File]("Builds the Python package with Skein and a Java runtime")
  val testedWheel: TaskKey[Unit] =
    taskKey[Unit]("Builds what tests install: the wheel of now where one can be built, else why there is none")

  /** Why no wheel can be built here, if so: its tests are skipped then. */
  def obstacle(scratch: File): Option[String] = {
    val said   = new StringBuilder
    val fetch  =
      Seq("python3", "-m", "pip", "download", "--quiet", "--no-deps", "--dest", scratch.getPath, "setuptools>=77")
    val status =
      try Process(fetch).!(ProcessLogger(line => said.append(line).append('\n')))
      catch { case missing: java.io.IOException => said.append(missing.getMessage); 1 }
    if (status == 0) None else Some(s"${fetch.mkString(" ")}: ${said.toString.takeRight(500)}")
  }

  /** @param sources
    *   with `pyproject.toml`
    * @param program
    *   what [[Packaging.build]] made
    */
  def build(sources: File, program: File, target: File, log: Logger): File = {
    val (copy, out) = (target / "package", target / "dist")
    IO.delete(Seq(copy, out))
    for (name <- Seq("pyproject.toml", "README.md")) IO.copyFile(sources / name, copy / name)
    val code = sources / "src"
    for (file <- ((code * "*.py") +++ (code / "skein_uav" ** ("*.py" || "py.typed"))).get)
      IO.copyFile(file, copy / "src" / IO.relativize(code, file).get)
    val home = copy / "src" / "skein_uav" / "skein"
    IO.copyDirectory(program, home, overwrite = true, preserveLastModified = true, preserveExecutable = true)
    IO.delete(home / "lib" / ".timed") // files of a wheel have the time of their installation
    val tag    = s"--config-settings=--build-option=--plat-name=${Packaging.wheelPlatform}"
    val pip    =
      Seq("python3", "-m", "pip", "wheel", "--quiet", "--no-deps", tag, "--wheel-dir", out.getPath, copy.getPath)
    val status = Process(pip, sources, "SOURCE_DATE_EPOCH" -> (Packaging.firstDay / 1000).toString).!(log)
    val built  = (out ** "*.whl").get
    if (status != 0 || built.isEmpty) sys.error(s"${pip.mkString(" ")} ended with status $status")
    log.info(s"${built.head}: ${built.head.length >> 20} MiB")
    built.head
  }
}
