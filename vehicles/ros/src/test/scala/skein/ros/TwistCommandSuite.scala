package skein.ros

import skein.policy.{Action, Yaw}
import skein.port.VehicleError
import skein.ros.message.{Time, Vector3 as RosVector}
import skein.signal.Kinematics
import skein.units.*

class TwistCommandSuite extends munit.FunSuite:
  private val now =
    Kinematics(Vector3(10, 20, -30), Vector3(1, 2, -0.5), Quaternion.ofYaw(0.5), Vector3(0.1, -0.2, 0.3))

  private def near(a: Vector3, b: Vector3): Unit = assert((a - b).norm < 1e-9, s"$a, $b")

  private def of(action: Action): (RosVector, Double) =
    TwistCommand.of(action, now).fold(error => fail(error.message), twist => (twist.linear, twist.angular.z))

  test("the odometry that the simulator publishes is read as the motion that it was made from"):
    val message = VehicleMessages.odometry(Instant.ofNanos(7), "a", now)
    val back    = TwistCommand.kinematics(message).fold(fail(_), identity)
    near(back.positionNed, now.positionNed)
    near(back.velocityNed, now.velocityNed)
    near(back.angularVelocityFrd, now.angularVelocityFrd)
    assertEqualsDouble(back.orientation.yawRad, 0.5, 1e-12)
    assertEquals(message.header.stamp, Time(0, 7))
    val broken = message.copy(pose =
      message.pose.copy(pose =
        message.pose.pose.copy(position =
          skein.ros.message.Point(Double.NaN, 0, 0)
        )
      )
    )
    assert(TwistCommand.kinematics(broken).left.exists(_.startsWith("expected finite numbers")))

  test("velocities are in ENU, and a turn to the right is negative"):
    assertEquals(of(Action.Velocity(Vector3(1, 2, -3), Yaw.Turning(0.4))), (RosVector(2, 1, 3), -0.4))

  test("an altitude and a heading are reached by feedback, within limits"):
    val (linear, turn) = of(Action.VelocityAt(0, 0, Metres(-31), Yaw.Towards(Radians(0.6))))
    assertEqualsDouble(linear.z, 1, 1e-9)
    assertEqualsDouble(turn, -0.2, 1e-9)
    val (far, turned) = of(Action.VelocityAt(0, 0, Metres(-300), Yaw.Towards(Radians(3.5))))
    assertEqualsDouble(far.z, 3, 1e-9)
    assertEqualsDouble(turned, -1.5, 1e-9)

  test("a vehicle turns the shorter way round"):
    assert(of(Action.Turn(Yaw.Towards(Radians(0.5 + 1.9 * math.Pi))))._2 > 0)

  test("hovering is a velocity of zero, and landing is a velocity downwards"):
    assertEquals(of(Action.Hover), (RosVector(0, 0, -0.0), -0.0))
    assert(of(Action.Land)._1.z < 0)

  test("an attitude is not supported"):
    TwistCommand.of(Action.Attitude(Radians(0), Radians(0), Radians(0), 0.5), now) match
      case Left(VehicleError.Unsupported(_)) => ()
      case other                             => fail(s"$other")
