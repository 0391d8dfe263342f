package skein.ros

import java.io.File
import java.nio.file.{Files, Path}
import skein.testing.TemporaryFolders

class RosLibrarySuite extends munit.FunSuite, TemporaryFolders:
  private val rcl = System.mapLibraryName("rcl")

  private def prefix(withRcl: Boolean): Path =
    val folder = temporaryFolder()
    val lib    = Files.createDirectory(folder.resolve("lib"))
    if withRcl then Files.createFile(lib.resolve(rcl)): Unit
    folder

  private def folders(variables: (String, String)*) = RosLibrary.folders(variables.toMap)

  test("without ROS 2, one line states what was expected and what to do"):
    assertEquals(
      folders(),
      Left(
        s"ROS 2 was not found: expected $rcl in lib of a folder of AMENT_PREFIX_PATH (not set) or in a folder of " +
          "LD_LIBRARY_PATH (not set); run `source /opt/ros/DISTRO/setup.bash` first"
      )
    )

  test("environment variables that are set but have no ROS 2 are not reported as unset"):
    val empty = prefix(withRcl = false).toString
    val line  = folders("AMENT_PREFIX_PATH" -> empty, "LD_LIBRARY_PATH" -> "").swap.getOrElse("")
    assert(line.contains("of AMENT_PREFIX_PATH or in") && line.contains("LD_LIBRARY_PATH (not set)"), line)

  test("an overlay's folder precedes the folder below it, and the libraries' own folders come last"):
    val (overlay, below, own) = (prefix(withRcl = false), prefix(withRcl = true), prefix(withRcl = false))
    assertEquals(
      folders(
        "AMENT_PREFIX_PATH" -> s"$overlay${File.pathSeparator}$below",
        "LD_LIBRARY_PATH"   -> s"$own${File.pathSeparator}${below.resolve("lib")}"
      ),
      Right(Vector(overlay.resolve("lib"), below.resolve("lib"), own))
    )

  test("a vehicle's name must be valid as a part of a topic's name"):
    assertEquals(SimulatedTopics.mistake(Vector("Drone_1", "b2")), None)
    for name <- Seq("", "1st", "a b", "a/b", "a__b", "ä") do
      assert(SimulatedTopics.mistake(Vector("a", name)).exists(_.endsWith(s"got '$name'")), name)
