package skein.mujoco

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.testing.{PythonEnvironment, Unhurried}

/** A base for tests with MuJoCo's library: an installed one, or else PyPI's, installed for tests. */
trait MujocoHere extends munit.FunSuite, Unhurried:
  // A test's time limit must not include downloads.
  override def beforeAll(): Unit = MujocoHere.library: Unit

  protected def assumeMujoco(): Unit =
    assume(MujocoHere.library.isRight, s"MuJoCo is not here: ${MujocoHere.library}")

private object MujocoHere:
  lazy val library: Either[String, Path] =
    if sys.env.contains("SKEIN_MUJOCO") || sys.props.contains("skein.mujoco") then MujocoLibrary.find
    else
      for
        python <- PythonEnvironment("importlib.util", None, Seq("--no-deps", "mujoco-core==4.0.0")).install()
        file   <- libraryBelow(python.getParent.getParent)
        _ = sys.props("skein.mujoco") = file.toString
        found <- MujocoLibrary.find
      yield found

  private def libraryBelow(folder: Path): Either[String, Path] =
    Using.resource(Files.walk(folder))(
      _.iterator.asScala
        .filter(file => file.getFileName.toString == "mujoco" && Files.isDirectory(file))
        .flatMap(MujocoLibrary.inside)
        .nextOption()
        .toRight(s"no library below $folder")
    )
