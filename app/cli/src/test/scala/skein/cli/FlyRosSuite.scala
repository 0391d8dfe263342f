package skein.cli

import skein.scenario.Scenarios
import skein.testing.TemporaryFolders

/** `./skein fly --ros`, up to the point that needs ROS 2. */
class FlyRosSuite extends munit.FunSuite, TemporaryFolders:
  private given Scenarios = Scenarios.ours

  private val possible = Seq("--ros", "--loop", "stream", "--link", "none")

  private def said(words: String*): String =
    val ran = Ran.of(FlyCommand().run(words))
    assertEquals(ran.status, 1)
    assertEquals(ran.err.linesIterator.size, 1, ran.err)
    ran.err

  test("without ROS 2, a line states what is missing, before any warm-up"):
    assume(!Seq("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH").exists(sys.env.contains), "ROS 2 may be here")
    assert(said(possible*).contains("--ros: ROS 2 was not found: expected librcl.so in lib of a folder of"))

  test("if no loop is chosen, every loop that does not stop time is run"):
    assume(!Seq("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH").exists(sys.env.contains), "ROS 2 may be here")
    assert(clue(said("--ros", "--link", "none")).contains("ROS 2 was not found"))

  folder.test("loops of a configuration file count if the command names none"): folder =>
    val file = java.nio.file.Files.writeString(folder.resolve("paused.conf"), "skein.fly.loops = [paused]")
    assert(clue(said("--ros", "--link", "none", "--config", s"$file")).contains("other than paused"))

  for (what, words, expected) <- Seq(
      (
        "a simulator",
        possible ++ Seq("--simulator", "127.0.0.1:41451"),
        "not together with --simulator or --mavlink"
      ),
      ("MAVLink", possible :+ "--mavlink", "not together with --simulator or --mavlink"),
      ("virtual time", possible ++ Seq("--clock", "virtual"), "expected --clock real"),
      ("paused", Seq("--ros", "--loop", "paused", "--link", "none"), "expected loops other than paused"),
      (
        "a link with a rate",
        Seq("--ros", "--loop", "stream", "--link", "rate:50mbit,vpn"),
        "expected links without a rate"
      ),
      ("cars", possible ++ Seq("--scenario", "convoy"), "expected multirotors alone, got the car"),
      ("images", possible ++ Seq("--images", "front_center@5"), "expected no --images"),
      (
        "a scene",
        possible ++ Seq("--scene", "forest"),
        "--scene, --plant and --sensors are for the built-in simulator"
      )
    )
  do
    test(s"$what is refused with the reason"):
      assert(clue(said(words*)).contains(s"--ros: $expected"))

  test("a remapping without --ros is refused"):
    assert(said(
      "--ros-remap",
      "/a/odom:=/b/odom",
      "--loop",
      "stream"
    ).contains("--ros-remap: expected together"))
