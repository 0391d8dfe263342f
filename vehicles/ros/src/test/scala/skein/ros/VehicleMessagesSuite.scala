package skein.ros

import skein.ros.message.{Point, Time, Vector3 as RosVector}
import skein.signal.Kinematics
import skein.simulator.SeenVehicle
import skein.units.*

class VehicleMessagesSuite extends munit.FunSuite:
  /** Heads east at 4 m/s, turns right, and speeds up. */
  private val vehicle = SeenVehicle(
    "a",
    Kinematics(Vector3(10, 20, -30), Vector3(0, 4, -1), Quaternion.ofYaw(math.Pi / 2), Vector3(0, 0, 0.5)),
    Vector3(0, 2, 0),
    GeoLocation(47, 8, Metres(500))
  )
  private val at = Instant.ofNanos(1_700_000_000_020_000_000L)

  private def near(v: RosVector, x: Double, y: Double, z: Double): Unit =
    assert(math.abs(v.x - x) + math.abs(v.y - y) + math.abs(v.z - z) < 1e-12, v)

  test("odometry has the position in ENU and the velocities in the body's front, left and up"):
    val odometry = VehicleMessages.odometry(at, vehicle.name, vehicle.kinematics)
    assertEquals(odometry.header.stamp, Time(1_700_000_000, 20_000_000))
    assertEquals((odometry.header.frameId, odometry.childFrameId), ("map", "a/base_link"))
    assertEquals(odometry.pose.pose.position, Point(20, 10, 30))
    assertEqualsDouble(odometry.pose.pose.orientation.w, 1, 1e-12)
    near(odometry.twist.twist.linear, 4, 0, 1)
    near(odometry.twist.twist.angular, 0, 0, -0.5)

  test("the transform in the tree has the odometry's pose"):
    val frame    = VehicleMessages.transform(at, vehicle.name, vehicle.kinematics)
    val odometry = VehicleMessages.odometry(at, vehicle.name, vehicle.kinematics)
    assertEquals((frame.header, frame.childFrameId), (odometry.header, odometry.childFrameId))
    near(frame.transform.translation, 20, 10, 30)
    assertEquals(frame.transform.rotation, odometry.pose.pose.orientation)

  test("an inertial unit measures the acceleration and gravity's reaction upwards"):
    val imu = VehicleMessages.imu(at, vehicle)
    assertEquals(imu.header.frameId, "a/base_link")
    near(imu.linearAcceleration, 2, 0, 9.80665)
    near(imu.angularVelocity, 0, 0, -0.5)

  test("a GPS fix is given in degrees and metres"):
    val fix = VehicleMessages.fix(at, vehicle)
    assertEquals((fix.latitude, fix.longitude, fix.altitude), (47.0, 8.0, 500.0))
