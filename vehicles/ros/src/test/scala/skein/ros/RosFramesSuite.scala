package skein.ros

import skein.units.{Quaternion, Vector3}

class RosFramesSuite extends munit.FunSuite:
  private def near(a: Vector3, b: Vector3): Unit = assert((a - b).norm < 1e-12, s"$a, $b")

  private val turns =
    for
      roll  <- Seq(0.0, 0.3, -2)
      pitch <- Seq(0.0, -0.4, 1.2)
      yaw   <- Seq(0.0, 1, -1.5, 3)
    yield
      def about(angle: Double)(x: Int, y: Int, z: Int) =
        val (c, s) = (math.cos(angle / 2), math.sin(angle / 2))
        Quaternion(c, s * x, s * y, s * z)
      about(yaw)(0, 0, 1) * about(pitch)(0, 1, 0) * about(roll)(1, 0, 0)

  test("north, east and down are y, x and minus z; right and down of the body change their sign"):
    assertEquals(RosFrames.swapWorld(Vector3(1, 2, -3)), Vector3(2, 1, 3))
    assertEquals(RosFrames.swapBody(Vector3(1, 2, -3)), Vector3(1, -2, 3))

  test("in ROS a level vehicle has a yaw of 90 degrees when it heads north, and of 0 when it heads east"):
    val north = RosFrames.toEnu(Quaternion.Identity)
    assertEqualsDouble(2 * math.atan2(north.z, north.w), math.Pi / 2, 1e-12)
    val east = RosFrames.toEnu(Quaternion.ofYaw(math.Pi / 2))
    assertEqualsDouble(2 * math.atan2(east.z, east.w), 0, 1e-12)

  test("a body vector has equal world coordinates by either convention"):
    for q <- turns; frd <- Seq(Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0.2, -3, 5)) do
      near(RosFrames.toEnu(q).toWorld(RosFrames.swapBody(frd)), RosFrames.swapWorld(q.toWorld(frd)))

  test("a rotation that is converted there and back is unchanged, with w not negative"):
    for q <- turns do
      val enu  = RosFrames.toEnu(q)
      val back = RosFrames.toNed(enu)
      assert(enu.w >= 0 && back.w >= 0)
      near(back.toWorld(Vector3(1, 2, 3)), q.toWorld(Vector3(1, 2, 3)))
      assertEqualsDouble(RosFrames.heading(enu), q.yawRad, 1e-12)

  test(
    "a velocity in the level frame is turned by the heading into north, east and down"
  ):
    near(RosFrames.fromLevel(Vector3(2, 0, 1), 0), Vector3(2, 0, -1))
    near(RosFrames.fromLevel(Vector3(0, 2, 0), 0), Vector3(0, -2, 0))
    near(RosFrames.fromLevel(Vector3(2, 0, 0), math.Pi / 2), Vector3(0, 2, 0))
    near(RosFrames.fromLevel(Vector3(0, 2, 0), math.Pi / 2), Vector3(2, 0, 0))
