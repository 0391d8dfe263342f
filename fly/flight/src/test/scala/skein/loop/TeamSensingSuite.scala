package skein.loop

import scala.concurrent.{ExecutionContext, Future}
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.record.{EventKind, MemoryRecorder, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, Stamped}
import skein.units.*

class TeamSensingSuite extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic

  private object Silent extends VehiclePort:
    def read(): Future[Either[VehicleError, Stamped[Kinematics]]]               = Future.never
    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = Future.never
    def hover(): Future[Either[VehicleError, Boolean]]                          = Future.never

  test("a restart of the simulator that a message of another vehicle shows first is recorded"):
    val fleet    = PaperDuel().fleet
    val clock    = Clock.ofNanos(() => 0)
    val recorder = MemoryRecorder(Samples.heading)
    var take     = (_: Reading) => ()
    val messages = new Messages:
      def send(reading: Reading): Unit             = ()
      def onReceived(taken: Reading => Unit): Unit = take = taken
    val deciders = fleet.agents.indices.map(Decider(fleet, _))
    TeamSensing(
      fleet,
      Vector.fill(2)(Silent),
      Vector(0),
      clock,
      LoopSettings(),
      None,
      Some(messages),
      TeamParts(fleet),
      TeamLog(fleet, deciders, clock, recorder)
    ): Unit

    /** A message read at a time of ours, when the simulator's clock shows another. */
    def receive(number: Long, atMs: Double, showsMs: Double): Unit =
      val state          = Kinematics(Vector3.Zero, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
      def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
      take(Reading(1, number, Stamped(state, at(showsMs), at(atMs - 10), at(atMs + 10))))
    for number <- 0 to 4 do receive(number, 1000 + 100.0 * number, 100.0 * number)
    assertEquals(recorder.recording.events, Vector.empty)
    for number <- 5 to 9 do receive(number, 1000 + 100.0 * number, 100.0 * (number - 5))
    assertEquals(
      recorder.recording.events.map(one => (one.kind, one.vehicle, one.detail)),
      Vector((
        EventKind.ClockRestarted,
        Some(fleet.agents(1).name),
        "reading 5: the offset of the clocks has changed by 480.0 ms or more"
      ))
    )
