package skein.mujoco

import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import scala.jdk.CollectionConverters.*
import scala.util.control.NonFatal
import scala.util.{Try, Using}

/** Locates MuJoCo's C library: the path in the system property `skein.mujoco` or the environment variable
  * `SKEIN_MUJOCO`, or the library in PyPI's package `mujoco` of `python3`. Skein contains no part of it.
  */
object MujocoLibrary:
  /** The first version with batches of simulations. */
  private[mujoco] val LeastVersion = 4000000

  private val Named    = "SKEIN_MUJOCO"
  private val Property = "skein.mujoco"

  private lazy val found: Either[String, Path] = sys.props.get(Property).orElse(sys.env.get(Named)) match
    case Some(named) =>
      val path = Path.of(named)
      Either.cond(
        Files.isRegularFile(path),
        path,
        s"$Named: expected MuJoCo's library, there is no file $named"
      )
    case None =>
      fromPython.flatMap(inside).toRight(
        "MuJoCo's library was not found: expected python3 to know the package " +
          s"mujoco (pip install mujoco), or the library's path in $Named"
      )

  private lazy val loaded: Either[String, (path: Path, calls: MujocoCalls)] = found.flatMap: path =>
    try Right((path, MujocoCalls(path)))
    catch
      case NonFatal(error) =>
        Left(s"$path: expected MuJoCo's library of version 4 or newer: ${error.getMessage}")

  private[mujoco] lazy val calls: MujocoCalls =
    loaded.fold(reason => throw IllegalStateException(reason), _.calls)

  /** The library, or why none of the required version is found. Searched once. */
  lazy val find: Either[String, Path] = loaded.flatMap: one =>
    val version = one.calls.version.invokeExact(): Int
    Either.cond(
      version >= LeastVersion,
      one.path,
      s"${one.path}: expected MuJoCo ${LeastVersion / 1000000} or newer, got " +
        s"${version / 1000000}.${version / 1000 % 1000}.${version % 1000}"
    )

  /** The folder of the Python package `mujoco`. */
  private def fromPython: Option[Path] = Try {
    val asked = ProcessBuilder(
      "python3",
      "-c",
      "import importlib.util; print(importlib.util.find_spec('mujoco').submodule_search_locations[0])"
    ).redirectError(ProcessBuilder.Redirect.DISCARD).start()
    try
      Option.when(asked.waitFor(PatienceS, TimeUnit.SECONDS) && asked.exitValue == 0):
        Path.of(String(asked.getInputStream.readAllBytes()).trim)
    finally asked.destroy()
  }.toOption.flatten

  private[mujoco] def inside(folder: Path): Option[Path] =
    Using(Files.list(folder))(
      _.iterator.asScala
        .filter(file => LibraryName.matches(file.getFileName.toString))
        .maxByOption(_.toString)
    ).toOption.flatten

  private val LibraryName = raw"libmujoco\.(so(\.\d+)*|\d.*dylib|dylib)|mujoco\.dll".r

  private val PatienceS = 20L
