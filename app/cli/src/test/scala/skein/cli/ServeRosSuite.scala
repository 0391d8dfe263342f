package skein.cli

import java.nio.file.Files
import skein.testing.TemporaryFolders

/** `./skein serve --ros`, up to the point that needs ROS 2; `RosLiveSuite` tests the rest. */
class ServeRosSuite extends munit.FunSuite, TemporaryFolders:
  private def said(words: String*): String =
    val ran = Ran.of(ServeCommand.run(words))
    assertEquals(ran.status, 1)
    assertEquals(ran.err.linesIterator.size, 1, ran.err)
    ran.err

  private def settings(name: String, kind: String = "SimpleFlight"): String =
    val text = s"""{ "SettingsVersion": 1.2, "Vehicles": { "$name": { "VehicleType": "$kind" } } }"""
    Files.writeString(temporaryFolder().resolve("settings.json"), text).toString

  test("without ROS 2, a line states what is missing, and what to do"):
    assume(!Seq("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH").exists(sys.env.contains), "ROS 2 may be here")
    val line = said("--ros", "--listen", "127.0.0.1:0")
    assert(
      line.contains("--ros: ROS 2 was not found: expected librcl.so in lib of a folder of AMENT_PREFIX_PATH"),
      line
    )

  test("vehicles that another protocol commands are refused"):
    for other <- Seq(Seq("--mavlink"), Seq("--hil", "px4")) do
      val line = said("--ros" +: other*)
      assert(line.contains("--ros: not together with --mavlink or --hil"), line)

  test("a name that is invalid in a topic is refused before ROS 2 is searched for"):
    val line = said("--ros", "--settings", settings("Drone 1"))
    assert(line.contains("expected vehicles' names of letters, digits and single _"), line)
    assert(line.contains("got 'Drone 1'"), line)

  test("cars are refused"):
    val line = said("--ros", "--settings", settings("Car1", "PhysXCar"))
    assert(line.contains("--ros: expected multirotors alone, got the car Car1"), line)
