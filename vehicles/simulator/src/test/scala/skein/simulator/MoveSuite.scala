package skein.simulator

import skein.units.*
import upack.{Bool, Float32, Int32, Obj, Str}

class MoveSuite extends munit.FunSuite:

  test("a move answers true when its duration has elapsed"):
    val bench = Bench().hovering(-20)
    val move  = bench.velocityZ(5, 0, -20, 2)
    bench.pass(1.99)
    assertEquals(bench.answeredAt(move), None)
    bench.pass(0.02)
    assertEquals(bench.answeredAt(move), Some(2.0))
    assertEquals(bench.result(move), Some(true))

  test("a newer move cancels the older, which answers false immediately"):
    val bench = Bench().hovering(-20)
    val older = bench.velocityZ(5, 0, -20, 10)
    bench.pass(1)
    val newer = bench.velocityZ(0, 5, -20, 10)
    assertEquals(bench.answeredAt(older), Some(1.0))
    assertEquals(bench.result(older), Some(false))
    bench.pass(9.5)
    assertEquals(bench.result(newer), None)
    bench.pass(0.6)
    assertEquals(bench.result(newer), Some(true))

  test("60 ms after its move has ended a vehicle holds its position, overshooting"):
    val bench = Bench().hovering(-20)
    bench.velocityZ(5, 0, -20, 5)
    bench.pass(5.06)
    val left = bench.position()
    bench.pass(1.5)
    val overshoot = bench.position().x - left.x
    bench.pass(20)
    val back = bench.position()
    assert(math.abs(overshoot - 1.6) < 0.3, s"overshoot $overshoot m, AirSim's is 1.6 m")
    assert((back - left).norm < 0.1, s"holds at $back, wanted $left")

  test(
    "a duration of zero is answered immediately: with false for moveByVelocityZ, with true for other moves"
  ):
    val bench = Bench().hovering(-20)
    assertEquals(bench.result(bench.velocityZ(5, 0, -20, 0)), Some(false))
    assertEquals(bench.result(bench.velocity(5, 0, 0, 0)), Some(true))

  test("nose ahead, a velocity in the body's frame keeps the heading in which it began"):
    val bench = Bench().hovering(-20)
    val turn  = bench.call("rotateToYaw", Float32(90), Float32(20), Float32(1), Str("Evader"))
    bench.pass(20)
    assertEquals(bench.result(turn), Some(true))
    val ahead = Obj(Str("is_rate") -> Bool(false), Str("yaw_or_rate") -> Float32(0))
    bench.call(
      "moveByVelocityBodyFrame",
      Float32(5),
      Float32(0),
      Float32(0),
      Float32(3),
      Int32(1),
      ahead,
      Str("Evader")
    )
    bench.pass(2.9)
    assertEqualsDouble(math.toDegrees(bench.kinematics().orientation.toQuaternion.yawRad), 90, 5)
    assert(bench.position().y > 5, s"${bench.position()}")

  test("without API control a move answers true and does nothing"):
    val bench = Bench()
    val move  = bench.velocity(5, 0, -5, 1)
    bench.pass(1.1)
    assertEquals(bench.result(move), Some(true))
    assertEquals(bench.position(), Vector3.Zero)

  test("takeoff climbs to about half a metre below its goal and returns false, as in AirSim"):
    val bench = Bench().ready()
    val move  = bench.call("takeoff", Float32(20), Str(""))
    bench.pass(10)
    val took = bench.answeredAt(move).get
    assertEquals(bench.result(move), Some(false))
    assert(took > 2.9 && took < 3.9, s"took $took s, AirSim's 3.4 s")
    assert(math.abs(bench.position().z + 1.54) < 0.15, s"z = ${bench.position().z}, AirSim's -1.54")

  test("landing from 5.4 m takes AirSim's 26 s, ends on the ground and counts as a collision"):
    val bench = Bench().hovering(-5.4)
    val move  = bench.call("land", Float32(60), Str(""))
    bench.pass(60)
    val took = bench.answeredAt(move).get
    assertEquals(bench.result(move), Some(true))
    assert(math.abs(took - 26) < 2, s"took $took s")
    assertEqualsDouble(bench.position().z, 0, 1e-6)
    val collision = bench.now[skein.airsim.wire.CollisionInfo]("simGetCollisionInfo", Str(""))
    assert(collision.has_collided)
    assert(
      !bench.now[skein.airsim.wire.CollisionInfo]("simGetCollisionInfo", Str("")).has_collided,
      "read twice"
    )

  // The first follows a takeoff, the others the one before.
  for (speed, seconds, from) <-
      Seq((1.0, 25.3, -1.54), (3.0, 7.7, -10.0), (5.0, 5.1, -10.0), (10.0, 3.2, -10.0))
  do
    test(s"moveToPosition(20, 0, -10) at $speed m/s takes AirSim's $seconds s and ends near the goal"):
      val bench = Bench().hovering(from)
      val move  = bench.moveTo(20, 0, -10, speed)
      bench.pass(40)
      val took = bench.answeredAt(move).get
      assertEquals(bench.result(move), Some(true))
      assert(math.abs(took / seconds - 1) < 0.04, s"took $took s")
      bench.pass(10)
      val off = (bench.position() - Vector3(20, 0, -10)).norm
      assert(off < 1.4, s"$off m off")

  test("a path is flown through its corners"):
    val bench = Bench().hovering(-10)
    val path  = Seq(Vector3(10, 0, -10), Vector3(10, 10, -10), Vector3(0, 10, -10))
    val move  = bench.call(
      "moveOnPath",
      upickle.default.writeMsg(path.map(skein.airsim.wire.Vector3r(_))),
      Float32(3),
      Float32(60),
      Int32(1),
      upickle.default.writeMsg(skein.airsim.wire.YawMode(false, 0)),
      Float32(-1),
      Float32(1),
      Str("")
    )
    var nearest = Vector(Double.MaxValue, Double.MaxValue, Double.MaxValue)
    while bench.answeredAt(move).isEmpty && bench.elapsedS < 60 do
      bench.pass(0.1)
      val here = bench.position()
      nearest = nearest.zip(path).map((least, corner) => math.min(least, (corner - here).norm))
    assertEquals(bench.result(move), Some(true))
    assert(nearest.forall(_ < 2), s"passed the corners at $nearest m")

  test("rotateToYaw turns on the spot and answers true when it has stopped turning"):
    val bench = Bench().hovering(-10)
    val move  = bench.call("rotateToYaw", Float32(90), Float32(30), Float32(5), Str(""))
    bench.pass(30)
    assertEquals(bench.result(move), Some(true))
    val q = bench.kinematics().orientation.toQuaternion
    assertEqualsDouble(math.toDegrees(2 * math.atan2(q.z, q.w)), 90, 6)
    assert((bench.position() - Vector3(0, 0, -10)).norm < 0.2, s"drifted to ${bench.position()}")

  test("hover ends the current move, and the vehicle stays in place"):
    val bench = Bench().hovering(-20)
    val move  = bench.velocity(3, 0, 0, 30)
    bench.pass(3)
    val hover = bench.call("hover", Str(""))
    assertEquals(bench.result(move), Some(false))
    bench.pass(20)
    assertEquals(bench.result(hover), Some(false))
    assert(bench.kinematics().linear_velocity.toVector.norm < 0.01)

  test("a reset ends moves, returns vehicles to their starts and takes API control away"):
    val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
    val move  = bench.velocity(3, 0, 0, 30)
    bench.pass(3)
    bench.tell("reset")
    assertEquals(bench.result(move), Some(false))
    assertEquals(bench.position(), Vector3.Zero)
    assertEquals(bench.now[Boolean]("isApiControlEnabled", Str("Evader")), false)
    bench.pass(1)
    assertEquals(bench.position("Pursuer"), Vector3.Zero)

  test("wind displaces a vehicle that holds its position"):
    val bench = Bench().hovering(-10)
    bench.tell("simSetWind", upickle.default.writeMsg(skein.airsim.wire.Vector3r(0, 8, 0)))
    bench.pass(3)
    assert(bench.position().y > 0.01, s"stayed at ${bench.position()}")

  test("disarming in the air lets a vehicle fall to the ground"):
    val bench = Bench().hovering(-10)
    bench.tell("armDisarm", Bool(false), Str(""))
    bench.pass(10)
    assertEqualsDouble(bench.position().z, 0, 0.05)

  private def sticks(bench: Bench, entries: (String, Double)*): Unit =
    val fields =
      entries.map((key, value) => Str(key) -> Float32(value.toFloat)) :+ (Str("is_valid") -> Bool(true))
    bench.tell("moveByRC", upack.Obj(fields.head, fields.tail*), Str(""))

  private def byManual(bench: Bench): Long = bench.call(
    "moveByManual",
    Float32(5),
    Float32(5),
    Float32(-1),
    Float32(3),
    Int32(0),
    upickle.default.writeMsg(skein.airsim.wire.YawMode.Still),
    Str("")
  )

  test("moveByManual follows the sticks for its duration"):
    val bench = Bench().hovering(-10)
    sticks(bench, "pitch" -> 10000)
    val move  = byManual(bench)
    bench.pass(3.1)
    assertEquals(bench.result(move), Some(true))
    assert(bench.position().x > 1, s"${bench.position()}")

  test("without a remote control, moveByManual runs for its duration and does not move the vehicle"):
    val bench = Bench().hovering(-10)
    val move  = byManual(bench)
    bench.pass(3.1)
    assertEquals(bench.result(move), Some(true))
    assert((bench.position() - Vector3(0, 0, -10)).norm < 0.01)

  test("the sticks fly an armed vehicle that the API does not control"):
    val bench = Bench().ready()
    bench.tell("enableApiControl", Bool(false), Str(""))
    sticks(bench, "throttle" -> 0.8)
    bench.pass(2)
    assert(bench.position().z < -2, s"${bench.position()}")

  test("moveByMotorPWMs drives the rotors directly: at the hover control a level vehicle keeps its height"):
    def climb(control: Float) =
      val bench = Bench().hovering(-20)
      val move  = bench.call(
        "moveByMotorPWMs",
        Float32(control),
        Float32(control),
        Float32(control),
        Float32(control),
        Float32(1),
        Str("")
      )
      bench.pass(1.01)
      assertEquals(bench.result(move), Some(true))
      -20 - bench.position().z
    assertEqualsDouble(climb(0.5947f), 0, 0.02)
    // Thrust over weight by 10 %, less drag: g/10 · t²/2.
    assertEqualsDouble(climb(0.5947f * 1.1f), 0.49, 0.03)

  test("a vehicle can be placed at a pose whose quaternion is not of unit length"):
    val bench = Bench().ready()
    val pose  = skein.airsim.wire.Pose(
      skein.airsim.wire.Vector3r(1, 2, -3),
      skein.airsim.wire.Quaternionr(0, 0, 0, 0)
    )
    bench.tell("simSetVehiclePose", upickle.default.writeMsg(pose), Bool(true), Str(""))
    assertEquals(bench.kinematics().orientation, skein.airsim.wire.Quaternionr(1, 0, 0, 0))
    assertEquals(bench.position(), Vector3(1, 2, -3))
