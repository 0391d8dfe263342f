package skein.ros

import skein.testing.{Conclusive, Lengthy, Waiting}

/** The simulator's vehicles as part of a real ROS 2: Kilted's `rclpy` from PyPI, as a stranger uses it,
  * against a node of ours by its `librcl`, in a process of its own.
  */
class RosLiveSuite extends munit.FunSuite, Conclusive, Lengthy, Waiting:

  private def serving(speed: Double, stepMs: Int = 0)(use: => Unit): String =
    val served = ServedProcess.start(RosHere.variables(), speed, port = 0, stepMs)
    try use
    catch
      case failure: Throwable =>
        println(served.close())
        throw failure
    served.close()

  private def run(script: String, arguments: String*): String =
    val (status, output) = RosHere.python.run(script, RosHere.Domain +: arguments*)
    println(output)
    assertEquals(status, 0, output)
    assert(output.linesIterator.exists(_.startsWith("PASSED")), output)
    output

  for speed <- Seq(1, 4) do
    test(s"a P controller in rclpy, on simulated time, flies three vehicles to their goals, at speed $speed"):
      conclusive:
        val ended = serving(speed)(run("fly_three.py", Seq("30") ++ ServedProcess.Names*): Unit)
        println(ended)
        assert(
          ended.contains("notes: \n") && ended.contains("refused 0, failed 0") && ended.endsWith("ended"),
          ended
        )
        assert(ended.contains("package tf2_msgs for tf2_msgs/msg/TFMessage, it is not installed"), ended)

  test("with a clock that waits for commands, a node flies equal tracks twice, at ten times real time"):
    conclusive:
      def flown() =
        var said = ""
        serving(speed = 10, stepMs = 100) {
          said = run("repeat.py", Seq("200") ++ ServedProcess.Names*)
        }: Unit
        said.linesIterator.find(_.startsWith("PASSED"))
      assertEquals(flown(), flown())

  test("a camera and lidars are seen, in their frames, with their stamps and the camera's matrix"):
    conclusive:
      val ended = serving(speed = 1)(run("see_sensors.py", "5"): Unit)
      assert(ended.contains("notes: \n") && ended.endsWith("ended"), ended)

  test("garbage, foreign frames and foreign types are refused and reported, and the vehicles still fly"):
    conclusive:
      val ended = serving(speed = 1):
        run("disturb.py", "1000"): Unit
        run("fly_three.py", Seq("20") ++ ServedProcess.Names*): Unit
      println(ended)
      for line <- Seq(
          "/a/cmd_vel: refused a message: expected",
          "/b/setpoint_pose: refused a message: expected the frame map, got 'elsewhere'",
          "/c/cmd_vel: expected geometry_msgs/msg/TwistStamped, a node uses geometry_msgs/msg/Twist"
        )
      do assert(ended.contains(line), ended)

  test(
    "a vehicle port over remapped topics climbs, knows its ages, and a vehicle that is not there is named"
  ):
    conclusive:
      val ended = serving(speed = 1):
        val process = ServedProcess.program(RosHere.variables(), "flyOnRos").start()
        val output  = String(process.getInputStream.readAllBytes())
        println(output)
        assertEquals(process.waitFor, 0)
        assert(
          output.contains("missing: expected odometry on /nowhere/odom within 15 s, none arrived"),
          output
        )
        val Array(rise, age, unsure) =
          output.linesIterator.find(
            _.startsWith("climbed ")
          ).get.split(' ').drop(1).map(_.toDouble): @unchecked
        assert(rise > 1, output)
        assert(age >= 0 && age < 500 && unsure <= 10, output)
      assert(ended.contains("refused 0, failed 0"), ended)
