package skein.simulator

import scala.collection.mutable.ArrayBuffer
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.policy.Action
import skein.signal.Kinematics
import skein.units.*

/** A simulator whose clock waits for commands. Times are in milliseconds. */
class CommandLockstepSuite extends munit.FunSuite:
  private final class Flown(speed: Double = 10, stepMs: Double = 100):
    private val vehicles = Vector.tabulate(2)(index => VehicleSettings(s"v$index", Vector3(0, 10 * index, 0)))
    private val simulation =
      Simulation(SimulatorSettings(WorldSettings(vehicles), speed = speed), Instant.Epoch)
    private val seen = ArrayBuffer.empty[(atMs: Double, motions: Vector[Kinematics])]
    val inProcess    = InProcess(
      simulation,
      (at, vehicles) => seen += ((at.toNanos * 1e-6, vehicles.map(_.kinematics))),
      Some(Span.ofMillis(stepMs))
    )
    private var now = Instant.Epoch

    /** Lets real time pass in uneven steps. */
    def pass(ms: Double): Unit =
      val until = now + Span.ofMillis(ms)
      while now < until do
        now = (now + Span.ofMillis(7)).min(until)
        simulation.advance(now)

    def clockMs: Double = simulation.world.now.toNanos * 1e-6

    def command(vehicle: Int, stampMs: Double, up: Double = 2): Unit =
      simulation.advance(now)
      val stamp = Instant.Epoch + Span.ofMillis(stampMs)
      inProcess.act(vehicle, _ => Action.Velocity(Vector3(1, 0, -up)), Some(Span.ofSeconds(0.5)), Some(stamp))
      simulation.advance(now)

    def seenMs: Vector[Double] = seen.iterator.map(_.atMs).toVector

    /** Motions from a time on. */
    def motions(fromMs: Double): Vector[Vector[Kinematics]] =
      seen.iterator.filter(_.atMs >= fromMs).map(_.motions).toVector

  test("without a command the clock runs"):
    val flown = Flown()
    flown.pass(200)
    assertEqualsDouble(flown.clockMs, 2000, 1e-6)

  test("from the first command on, the clock stops every step until each vehicle has a command of that time"):
    val flown = Flown()
    flown.pass(21)
    flown.command(0, 200)
    flown.pass(50)
    // The first stop is also one of physics' steps of 3 ms.
    assertEqualsDouble(flown.clockMs, 300, 1e-6)
    flown.command(0, 280)
    flown.pass(50)
    assertEqualsDouble(flown.clockMs, 300, 1e-6)
    flown.command(0, 300)
    flown.command(1, 300)
    flown.pass(50)
    assertEqualsDouble(flown.clockMs, 300, 1e-6)
    flown.pass(500)
    assertEqualsDouble(flown.clockMs, 400, 1e-6)
    flown.command(1, 400)
    flown.pass(50)
    assertEqualsDouble(flown.clockMs, 400, 1e-6)
    flown.command(0, 400)
    flown.pass(50)
    assertEqualsDouble(flown.clockMs, 500, 1e-6)
    assertEquals(flown.seenMs.filter(_ > 200), Vector(300.0, 400.0, 500.0))
    assertEquals(flown.inProcess.commands, CommandCounts.Zero)

  test("the flight depends neither on the clock's speed nor on when commands arrive"):
    def flown(speed: Double, delayMs: Int => Double) =
      val it = Flown(speed)
      it.pass(30 / speed)
      it.command(0, 20)
      it.pass(300 / speed)
      it.command(0, 300)
      it.pass(600)
      for round <- 4 to 30 do
        it.pass(delayMs(round) + 100 / speed)
        it.command(0, 100 * round, up = round % 3)
      it.motions(fromMs = 300)
    val one = flown(1, _ => 1)
    assertEquals(one.size, 28)
    assert(one.last.head.positionNed.norm > 1, one.last)
    assertEquals(flown(10, round => 5 + 37 * round % 90), one)
    assertEquals(flown(100, round => 200 + 11 * round % 40), one)

  test("a command that comes after one with a later stamp is left out, and counted"):
    def flown(late: Boolean) =
      val it = Flown()
      it.pass(30)
      it.command(0, 200)
      it.pass(600)
      // The clock stands at 300 ms: these act now.
      it.command(0, 300, up = 2)
      if late then it.command(0, 280, up = 9)
      it.pass(50)
      // Before the next stop, at which this acts.
      it.command(0, 390, up = 1)
      if late then it.command(0, 385, up = 9)
      it.command(0, 400, up = 3)
      it.pass(50)
      (it.motions(fromMs = 300), it.inProcess.commands.late)
    val (motions, late) = flown(late = true)
    assertEquals((motions, late), (flown(late = false)._1, 2L))

  test("after a second without a command it runs on, and reports that; the next command makes it wait again"):
    val flown = Flown()
    flown.pass(20)
    flown.command(0, 180)
    flown.pass(900)
    assertEqualsDouble(flown.clockMs, 300, 1e-6)
    flown.pass(300)
    assert(flown.clockMs > 1000, flown.clockMs)
    assertEquals(flown.inProcess.commands, CommandCounts(missed = 1, late = 0))
    val at = flown.clockMs
    flown.command(0, at - 10)
    flown.pass(500)
    assertEqualsDouble(flown.clockMs, (at / 300).floor * 300 + 300, 1e-6)

  test("a command with a stamp of the future acts on arrival"):
    val flown = Flown()
    flown.pass(20)
    flown.command(0, 1e9)
    flown.pass(100)
    assertEqualsDouble(flown.clockMs, 1200, 1e-6)
