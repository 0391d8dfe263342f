package skein.simulator

import upack.{Arr, Binary, Bool, Float32, Float64, Int32, Obj, Str}

class ErrorSuite extends munit.FunSuite:

  test("the error for an unknown function has rpclib's text"):
    assertEquals(
      Bench().error("nosuch", Int32(1)),
      "rpclib: server could not find function 'nosuch' with argument count 1."
    )

  test("the error for a wrong number of arguments has rpclib's text, with its swapped numbers"):
    assertEquals(
      Bench().error("ping", Int32(1)),
      "rpclib: client error C0002: Function 'ping' was called with " +
        "an invalid number of arguments. Expected: 1, got: 0"
    )

  test("an argument of another type is a bad cast"):
    assertEquals(
      Bench().error("simPause", Int32(1)),
      "rpclib: function 'simPause' (called with 1 arg(s)) threw an exception. " +
        "The exception contained this information: std::bad_cast."
    )
    val yawAsArray =
      Seq(Float32(1), Float32(0), Float32(0), Float32(1), Int32(0), Arr(Bool(true), Float32(0)), Str(""))
    assert(Bench().error("moveByVelocity", yawAsArray*).contains("std::bad_cast"))

  test("integers are accepted as floats, bin as str, and yaw modes with missing or additional keys"):
    val bench = Bench().ready()
    val move  = bench.call(
      "moveByVelocity",
      Int32(1),
      Int32(0),
      Float64(-1.5),
      Int32(1),
      Int32(0),
      Obj(Str("is_rate") -> Bool(true), Str("more") -> Int32(1)),
      Binary("Evader".getBytes)
    )
    bench.pass(1.1)
    assertEquals(bench.result(move), Some(true))

  test("the error for a missing vehicle names it, with the text of either kind of function"):
    assert(
      Bench()
        .error("getMultirotorState", Str("Nope"))
        .contains(
          "Vehicle API for 'Nope' is not available. This could either because " +
            "this is simulation-only API or this vehicle does not exist"
        )
    )
    assert(
      Bench()
        .error("simGetGroundTruthKinematics", Str("Nope"))
        .contains(
          "Vehicle Sim-API for 'Nope' is not available. This could either " +
            "because this is not a simulation or this vehicle does not exist"
        )
    )

  test("a takeoff in motion is refused with the speed"):
    val bench = Bench().hovering(-20)
    bench.velocity(5, 0, 0, 1)
    bench.pass(1.01)
    assert(
      bench
        .error("takeoff", Float32(20), Str("Evader"))
        .contains("Cannot perform takeoff because vehicle is already moving with velocity ")
    )

  test("paths that cannot be flown are refused as in AirSim"):
    val bench                                           = Bench().hovering(-20)
    def fly(drivetrain: Int, lookahead: Double): String = bench.error(
      "moveToPosition",
      Float32(1),
      Float32(0),
      Float32(-20),
      Float32(5),
      Float32(60),
      Int32(drivetrain),
      Obj(Str("is_rate") -> Bool(true)),
      Float32(lookahead.toFloat),
      Float32(0),
      Str("")
    )
    assert(fly(1, -1).contains("Yaw cannot be specified as rate if drivetrain is ForwardOnly"))
    assert(fly(0, 0).contains("lookahead distance cannot be 0"))
    assertEquals(bench.now[Boolean]("ping"), true)

  test("the error for a missing sensor names it"):
    assert(Bench().error("getLidarData", Str(""), Str("")).contains("No lidar with name  exist on vehicle"))

  test("NaN is refused and changes nothing"):
    val bench = Bench().hovering(-20)
    assert(bench.error("simSetWind", Obj(Str("x_val") -> Float32(Float.NaN))).contains("finite"))
    bench.pass(0.1)
    assert(bench.position().norm.isFinite)
