package skein.simulator

import scala.collection.mutable.ArrayBuffer
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.policy.{Action, Yaw}
import skein.rpc.RpcRequest
import skein.signal.Kinematics
import skein.units.*
import upack.{Bool, Float32, Int32, Msg, Str}

/** The simulation as other parts of this process see and fly it, without threads and without a clock. */
class InProcessSuite extends munit.FunSuite:
  private final class Flown(speed: Double = 1):
    val simulation = Simulation(
      SimulatorSettings(
        WorldSettings(Vector.tabulate(2)(index => VehicleSettings(s"v$index", Vector3(0, 10 * index, 0)))),
        speed = speed
      ),
      Instant.Epoch
    )
    val seen      = ArrayBuffer.empty[(at: Instant, vehicles: Vector[SeenVehicle])]
    val inProcess = InProcess(simulation, (at, vehicles) => seen += ((at = at, vehicles = vehicles)))
    var now       = Instant.Epoch

    /** Advances the caller's clock in uneven steps. */
    def run(seconds: Double): Unit =
      val until = now + Span.ofSeconds(seconds)
      while now < until do
        now = (now + Span.ofMillis(33)).min(until)
        simulation.advance(now)

    def last(vehicle: Int): Kinematics = seen.last.vehicles(vehicle).kinematics

    def call(method: String, params: Msg*): Unit =
      simulation.receive(SimulatorCall(0, RpcRequest(0, method, params.toVector, false)), now)

  private val climb: Kinematics => Action = _ => Action.Velocity(Vector3(0, 0, -2))

  test("an onlooker sees all vehicles every 20 ms of simulated time, however the clock is read"):
    for speed <- Seq(1.0, 10.0) do
      val flown = Flown(speed)
      flown.run(0.5)
      val times = flown.seen.map(_.at.toNanos).toVector
      assertEquals(times, Vector.tabulate((25 * speed).toInt + 1)(_ * 20_000_000L))
      assertEquals(flown.seen.head.vehicles.map(_.name), Vector("v0", "v1"))
      assertEquals(flown.last(1).positionNed, Vector3(0, 10, 0))

  test("an onlooker sees nothing while the simulator is paused, and continues at the next 20 ms"):
    val flown = Flown()
    flown.run(0.1)
    flown.call("simPause", Bool(true))
    val before = flown.seen.size
    flown.run(1)
    assertEquals(flown.seen.size, before)
    flown.call("simPause", Bool(false))
    flown.run(0.1)
    assertEquals(flown.seen.size, before + 5)

  test("a vehicle on the ground takes off by an action, and holds its position once that is over"):
    val flown = Flown()
    flown.inProcess.act(1, climb, Some(Span.ofSeconds(3)))
    flown.run(3)
    val climbed = flown.last(1)
    assert(climbed.positionNed.z < -3 && climbed.velocityNed.z < -1.5, climbed)
    flown.run(5)
    val held = flown.last(1)
    assert(held.velocityNed.norm < 0.2 && held.positionNed.z < climbed.positionNed.z, held)
    assertEquals(flown.last(0).positionNed, Vector3.Zero)

  test("a vehicle takes off by an action that leads upwards and to any side"):
    for
      side <- Seq(Vector3(3, 1, 0), Vector3(-3, 3, 0), Vector3(0, -3, 0))
      up   <- Seq(0.5, 3.0)
      yaw  <- Seq(Yaw.Still, Yaw.Towards(Radians(math.Pi / 2)), Yaw.Turning(1))
    do
      val flown = Flown()
      flown.inProcess.act(0, _ => Action.Velocity(side - Vector3(0, 0, up), yaw), None)
      flown.run(6)
      val at = flown.last(0)
      assert(at.positionNed.z < -4 * up, s"$side, $up, $yaw: $at")
      assert((at.velocityNed - side + Vector3(0, 0, up)).norm < 0.7, s"$side, $up, $yaw: $at")

  test("an action without an end continues, in the world's frame, until another replaces it"):
    val flown = Flown()
    val there = Vector3(3, 6, -8)
    flown.inProcess.act(1, _ => Action.Position(there, MetresPerSecond(2), Yaw.Towards(Radians(1))), None)
    flown.run(20)
    // Without an end, AirSim's way to a position goes to and fro about it.
    assert((flown.last(1).positionNed - there).norm < 1, flown.last(1))
    assertEqualsDouble(flown.last(1).orientation.yawRad, 1, 0.1)
    flown.inProcess.act(1, _ => Action.VelocityAt(0, 2, Metres(-5)), None)
    flown.run(20)
    assertEqualsDouble(flown.last(1).positionNed.z, -5, 0.5)
    assertEqualsDouble(flown.last(1).velocityNed.y, 2, 0.2)

  test("an action is evaluated immediately and then every 20 ms, by the present motion"):
    val flown = Flown()
    var calls = 0
    flown.inProcess.act(
      0,
      now =>
        calls += 1
        climb(now)
      ,
      Some(Span.ofSeconds(1))
    )
    flown.run(1.5)
    assertEquals(calls, 1 + 50)

  test("a client's move replaces an action, and an action ends a move, which is then answered"):
    val flown = Flown()
    flown.inProcess.act(0, climb, None)
    flown.run(4)
    val up = flown.last(0).positionNed.z
    flown.call("moveByVelocity", Float32(3), Float32(0), Float32(0), Float32(30), Int32(0), still, Str("v0"))
    flown.run(4)
    assertEqualsDouble(flown.last(0).velocityNed.x, 3, 0.3)
    assert(flown.last(0).velocityNed.z.abs < 0.3 && flown.last(0).positionNed.z < up, flown.last(0))
    flown.simulation.takeAnswers(): Unit
    flown.inProcess.act(0, climb, None)
    flown.run(2)
    assertEquals(flown.simulation.takeAnswers().map(_.result), Seq(Right(Bool(false))))
    assert(flown.last(0).velocityNed.z < -1.5, flown.last(0))

  test("a reset ends an action"):
    val flown = Flown()
    flown.inProcess.act(0, climb, None)
    flown.run(2)
    flown.call("reset")
    flown.run(2)
    assertEqualsDouble(flown.last(0).positionNed.z, 0, 0.01)

  private val still = upack.Obj(Str("is_rate") -> Bool(true), Str("yaw_or_rate") -> Float32(0))
