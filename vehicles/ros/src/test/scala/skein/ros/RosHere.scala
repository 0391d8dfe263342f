package skein.ros

import java.nio.file.{Files, Path}
import munit.Assertions.assume
import scala.jdk.CollectionConverters.*
import scala.sys.process.Process
import scala.util.{Try, Using}
import skein.testing.PythonEnvironment

/** ROS 2 Kilted with Fast DDS from PyPI, installed for tests: a stranger's `rclpy`, and the `librcl` of the
  * node.
  */
private[ros] object RosHere:
  val python: PythonEnvironment = PythonEnvironment(
    "rclpy, nav_msgs.msg, sensor_msgs.msg",
    Some("/ros/fly_three.py"),
    Seq("ros-kilted-rclpy[fastrtps]==9.1.2", "numpy") ++
      Seq("geometry", "nav", "sensor").map(name => s"ros-kilted-$name-msgs==5.5.1") :+
      "ros-kilted-rosgraph-msgs==2.3.0"
  )

  /** A domain of the test's own: other programs of this machine may use ROS 2. */
  val Domain: String = (100 + ProcessHandle.current.pid % 100).toString

  /** Environment variables of a JVM whose node uses this library. PyPI's libraries need symbols of Python's,
    * unlike those of an installed ROS 2.
    */
  def variables(): Map[String, String] =
    val prefix  = python.python().getParent.getParent
    val library = pythonLibrary(prefix.resolve("bin").resolve("python"))
    assume(library.isDefined, "the Python here has no shared library, which PyPI's ROS 2 needs beside a JVM")
    val folders = prefix.resolve("lib") +: Using.resource(Files.walk(prefix, 4))(
      _.iterator.asScala.filter(_.getFileName.toString.matches("ros_.*\\.libs")).toVector
    )
    Map(
      "LD_LIBRARY_PATH"               -> folders.mkString(":"),
      "LD_PRELOAD"                    -> library.get.toString,
      "ROS_DOMAIN_ID"                 -> Domain,
      "ROS_AUTOMATIC_DISCOVERY_RANGE" -> "LOCALHOST"
    )

  private def pythonLibrary(python: Path): Option[Path] =
    val script =
      "import sysconfig; print(sysconfig.get_config_var('LIBDIR') + '/' + sysconfig.get_config_var('INSTSONAME'))"
    val found = Try(Path.of(Process(Seq(python.toString, "-c", script)).!!.trim)).toOption
    (found ++ found.map(path => Path.of("/usr/lib/x86_64-linux-gnu").resolve(path.getFileName)))
      .find(path => Files.isRegularFile(path) && path.toString.contains(".so"))
