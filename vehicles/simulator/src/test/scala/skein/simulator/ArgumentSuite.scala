package skein.simulator

import skein.airsim.wire.*
import skein.rpc.Rpclib
import skein.units.Instant
import upack.*

/** Conversions of arguments, as observed with AirSim's own RPC code. */
class ArgumentSuite extends munit.FunSuite:

  private def read[A](value: Msg)(using argument: Argument[A]): Either[String, A] =
    try Right(argument.read(value))
    catch case bad: BadArgument => Left(bad.getMessage)

  private def refusedAs[A: Argument](name: String, values: Msg*): Unit =
    for value <- values do assertEquals(read[A](value), Left("std::bad_cast"), s"$value as $name")

  private val map = Obj(Str("x_val") -> Float32(1))

  test("only an integer or a float is accepted as a number"):
    for value <- Seq(Int32(2), Int64(2), UInt64(2), Float32(2), Float64(2)) do
      assertEquals(read[Float](value), Right(2f))
      assertEquals(read[Double](value), Right(2.0))
    refusedAs[Float]("a float", Null, Bool(true), Str("2"), Binary(Array(2)), Arr(Int32(2)), map)
    refusedAs[Double]("a double", Null, Bool(true), Str("2"), Binary(Array(2)), Arr(Int32(2)), map)
    assertEquals(read[Double](UInt64(-1L)), Right(18446744073709551616.0))

  test("an integer is read neither from a float nor from outside its type's range"):
    assertEquals(read[Int](Int32(-3)), Right(-3))
    refusedAs[Int](
      "an integer",
      Float32(0),
      Float64(1),
      Null,
      Bool(true),
      Str("0"),
      Int64(1L << 31),
      UInt64(-1L)
    )
    assertEquals(read[Argument.Unsigned32](Int64(0xffffffffL)).map(_.toLong), Right(0xffffffffL))
    refusedAs[Argument.Unsigned32]("unsigned", Int32(-1), Int64(1L << 32), Float32(3), Null)
    assertEquals(read[Instant](UInt64(7)), Right(Instant.ofNanos(7)))
    refusedAs[Instant]("a time stamp", Int32(-1), UInt64(-1L), Float64(7), Null)

  test("a boolean is read only from a boolean, and a string only from str or bin"):
    assertEquals(read[Boolean](Bool(true)), Right(true))
    refusedAs[Boolean]("a boolean", Int32(1), Null, Str("true"), Float32(1))
    assertEquals(read[String](Str("é")), Right("é"))
    assertEquals(read[String](Binary("é".getBytes("UTF-8"))), Right("é"))
    refusedAs[String]("a string", Null, Int32(1), Bool(false), Arr(), map)

  test("missing keys keep their defaults at any depth, unknown keys are skipped"):
    assertEquals(read[Vector3r](map), Right(Vector3r(1, 0, 0)))
    assertEquals(read[Vector3r](Obj()), Right(Vector3r.Zero))
    assertEquals(
      read[Pose](Obj(Str("position") -> map, Str("more") -> Null)),
      Right(Pose(Vector3r(1, 0, 0), Quaternionr(1, 0, 0, 0)))
    )
    assertEquals(read[YawMode](Obj()), Right(YawMode(true, 0)))
    assertEquals(read[Seq[Vector3r]](Arr(map, Obj())), Right(Seq(Vector3r(1, 0, 0), Vector3r.Zero)))
    assertEquals(read[RcData](Obj(Binary("pitch".getBytes) -> Int32(1))).isRight, true)

  test("a vector, pose or yaw mode must be a map, and a wrong value within one invalidates it"):
    refusedAs[Vector3r]("a vector", Null, Arr(Int32(1), Int32(2), Int32(3)), Str("x"), Int32(1))
    refusedAs[Vector3r]("a vector", Obj(Str("x_val") -> Null), Obj(Int32(1) -> Int32(1)))
    refusedAs[Pose]("a pose", Null, Obj(Str("position") -> Null), Obj(Str("orientation") -> Arr()))
    refusedAs[YawMode]("a yaw mode", Null, Arr(Bool(true), Float32(0)), Obj(Str("is_rate") -> Int32(1)))
    refusedAs[Seq[Vector3r]]("a path", Null, map, Arr(Null), Arr(Arr(Int32(1), Int32(2), Int32(3))))

  test("numbers that are not finite are refused, also those too large for a 32-bit float"):
    val refused = Left("parameters must be finite numbers")
    for value <- Seq(Float32(Float.NaN), Float64(Double.NegativeInfinity), Float64(1e300)) do
      assertEquals(read[Float](value), refused)
      assertEquals(read[Vector3r](Obj(Str("y_val") -> value)), refused)
    assertEquals(read[Double](Float64(1e300)), Right(1e300))
    assertEquals(read[Double](Float64(Double.NaN)), refused)

  private val samples = Seq[Msg](
    Null,
    Bool(true),
    Int32(-1),
    UInt64(-1L),
    Float32(Float.NaN),
    Float64(1e300),
    Str(""),
    Str("Evader"),
    Binary(Array[Byte](-1)),
    Arr(),
    Arr(Null),
    Obj(),
    Obj(Null         -> Null),
    Obj(Str("x_val") -> Null, Str("position") -> Null, Str("is_rate") -> Null)
  )

  test("no value of any parameter of any function stops the simulator"):
    val bench = Bench()
    for method <- Simulation.methods; place <- 0 until method.arity; value <- samples do
      for others <- Seq[Msg](Null, Str(""), Int32(0), Float32(1), Obj(), Bool(false)) do
        val params = Vector.fill(method.arity)(others).updated(place, value)
        bench.call(method.name, params*)
        bench.tell("simPause", Bool(false))
        bench.pass(0.001)
    // Moves that arrive faster than they end are all answered when these have ended.
    bench.tell("reset")
    assertEquals(bench.now[Boolean]("ping"), true)

  test("nil as vehicle, yaw mode, wind, pose, path or sensor is a bad cast"):
    val (one, name) = (Float32(1), Str(""))
    val calls       = Seq[(String, Seq[Msg])](
      "getMultirotorState"          -> Seq(Null),
      "simGetGroundTruthKinematics" -> Seq(Null),
      "moveByVelocity"              -> Seq(one, one, one, one, Int32(0), Null, name),
      "moveByVelocity"              -> Seq(one, one, one, one, Float32(0), Obj(), name),
      "simSetWind"                  -> Seq(Null),
      "simSetVehiclePose"           -> Seq(Null, Bool(true), name),
      "moveOnPath"                  -> Seq(Null, one, one, Int32(0), Obj(), one, one, name),
      "moveOnPath"                  -> Seq(Arr(Null), one, one, Int32(0), Obj(), one, one, name),
      "getImuData"                  -> Seq(Null, name),
      "simContinueForFrames"        -> Seq(Int32(-1)),
      "simContinueForFrames"        -> Seq(Float32(1)),
      "takeoff"                     -> Seq(Bool(true), name)
    )
    val bench = Bench()
    for (method, params) <- calls do
      assertEquals(bench.error(method, params*), Rpclib.threw(method, params.size, "std::bad_cast"))

  test("a function that fails internally answers with its exception"):
    val broken = ServerMethod("broken", Nil, (_, _) => throw IllegalStateException("within"))
    broken(Bench().simulation, Vector.empty) match
      case CallOutcome.Threw(text) => assertEquals(text, "java.lang.IllegalStateException: within")
      case other                   => fail(s"$other")
