package skein.ros

import skein.policy.{Action, Yaw}
import skein.ros.message.*
import skein.ros.message.Vector3 as RosVector
import skein.signal.Kinematics
import skein.units.Vector3 as Ned
import skein.units.Quaternion as Turned

class VehicleCommandsSuite extends munit.FunSuite:
  private def heading(rad: Double) = Kinematics(Ned.Zero, Ned.Zero, Turned.ofYaw(rad), Ned.Zero)

  private val twist = Twist(RosVector(3, 1, 0.5), RosVector(9, 9, 0.25))

  private def velocity(frame: String, headingRad: Double): (Ned, Yaw) =
    VehicleCommands.velocity("a", frame, twist).map(_(heading(headingRad))) match
      case Right(Action.Velocity(ned, yaw)) => (ned, yaw)
      case other                            => fail(s"$other")

  private def near(a: Ned, b: Ned): Unit = assert((a - b).norm < 1e-12, s"$a, $b")

  test("a velocity in the vehicle's frame turns with its heading"):
    for frame <- Seq("", "base_link", "a/base_link") do
      near(velocity(frame, 0)._1, Ned(3, -1, -0.5))
      near(velocity(frame, math.Pi / 2)._1, Ned(1, 3, -0.5))

  test("a velocity in the world's frame is east, north and up, whatever the heading"):
    for rad <- Seq(0.0, 2.0) do near(velocity("map", rad)._1, Ned(1, 3, -0.5))

  test("a turn to the left is positive in ROS"):
    assertEquals(velocity("map", 0)._2, Yaw.Turning(-0.25))

  test("other frames, and numbers that are not finite, are refused"):
    assertEquals(
      VehicleCommands.velocity("a", "b/base_link", twist),
      Left("expected the frame a/base_link or map, got 'b/base_link'")
    )
    val nan = twist.copy(linear = RosVector(Double.NaN, 0, 0))
    assert(VehicleCommands.velocity("a", "", nan).left.exists(_.startsWith("expected finite numbers")))

  private def pose(frame: String, turned: Quaternion) =
    PoseStamped(Header(Time(0, 0), frame), Pose(Point(5, 6, 7), turned))

  private def flown(pose: PoseStamped, at: Ned = Ned.Zero) =
    VehicleCommands.position(pose).map(_(heading(0).copy(positionNed = at)))

  private def yaw(turned: Quaternion): Yaw = flown(pose("", turned)) match
    case Right(Action.Velocity(_, yaw)) => yaw
    case other                          => fail(s"$other")

  test("a pose is a position in ENU, approached at the cruising speed, and a heading"):
    flown(pose("map", Quaternion(0, 0, 0, 1)), Ned(1006, 5, -7)) match
      case Right(Action.Velocity(ned, Yaw.Towards(heading))) =>
        assertEqualsDouble(ned.x, -1.5 * VehicleCommands.Cruise.value, 1e-9)
        assertEqualsDouble(ned.y.abs + ned.z.abs, 0, 1e-9)
        assertEqualsDouble(heading.value, math.Pi / 2, 1e-12)
      case other => fail(s"$other")

  test("a vehicle stays at its pose"):
    assertEquals(
      flown(pose("", Quaternion(0, 0, 0, 0)), Ned(6, 5, -7)),
      Right(Action.Velocity(Ned.Zero, Yaw.Still))
    )

  test("a quaternion of zeros sets no heading; one of any other length sets its heading"):
    assertEquals(yaw(Quaternion(0, 0, 0, 0)), Yaw.Still)
    yaw(Quaternion(0, 0, 2, 2)) match
      case Yaw.Towards(heading) => assertEqualsDouble(heading.value, 0, 1e-12)
      case other                => fail(s"$other")

  test("a pose in another frame is refused"):
    assertEquals(flown(pose("odom", Quaternion(0, 0, 0, 1))), Left("expected the frame map, got 'odom'"))
