package skein.loop

import scala.concurrent.{ExecutionContext, Future}
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.record.{MemoryRecorder, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, Stamped}
import skein.units.*

class TeamSensingSuite extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic

  test("messages of other vehicles do not align the clocks: their delays hold the way between vehicles"):
    val fleet    = PaperDuel().fleet
    val clock    = Clock.ofNanos(() => 2_000_000_000)
    val recorder = MemoryRecorder(Samples.heading)
    var take     = (_: Reading) => ()
    val messages = new Messages:
      def send(reading: Reading): Unit             = ()
      def onReceived(taken: Reading => Unit): Unit = take = taken
    val deciders       = fleet.agents.indices.map(Decider(fleet, _))
    val state          = Kinematics(Vector3.Zero, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
    def stamped(ms: Double, validMs: Double, toMs: Double) = Stamped(state, at(validMs), at(ms), at(toMs))
    val port                                               = new VehiclePort:
      def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
        Future.successful(Right(stamped(1000, 110, 1020)))
      def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = Future.never
      def hover(): Future[Either[VehicleError, Boolean]]                          = Future.never
    val sensing = TeamSensing(
      Vector.fill(2)(port),
      None,
      Some(messages),
      TeamParts(fleet, Vector(0), clock, LoopSettings(), TeamLog(fleet, deciders, clock, recorder))
    )
    def receive() = for number <- 0 to 4 do take(Reading(1, number, stamped(1000, 110, 1420)))
    receive()
    assertEquals(sensing.ageOf(Some(at(110))), None)
    assert(sensing.read(0).value.exists(_.isSuccess))
    receive()
    // The clock shows 2000 ms now, and showed 1010 ms at the reading.
    assertEquals(sensing.ageOf(Some(at(110))), Some(Span.ofMillis(990)))
    assertEquals(recorder.recording.readings.size, 11)
