package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.policy.Action
import skein.port.{SteppedTime, VehicleError, VehiclePort}
import skein.record.{EventKind, MemoryRecorder, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

class PausedLoopSuite extends munit.FunSuite:
  private val lost = Left(VehicleError.TimedOut("lost: no answer within 500 ms"))

  /** A vehicle whose readings in `failing`, and whose first hovers, fail. */
  private final class Fragile(port: VehiclePort, isPaused: () => Boolean, failing: Range, failedHovers: Int)
      extends VehiclePort:
    private var reads, hovers = 0
    var readWhileItRan        = false
    var hovering              = false
    var toldWhilePaused       = false

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      reads += 1
      readWhileItRan ||= !isPaused()
      if failing.contains(reads) then Future.successful(lost) else port.read()

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      hovering = false
      port.act(action, lasts)

    def hover(): Future[Either[VehicleError, Boolean]] =
      hovers += 1
      toldWhilePaused ||= isPaused()
      if hovers <= failedHovers then Future.successful(lost)
      else
        hovering = true
        port.hover()

  /** A simulator whose steps in `failing` fail, and which resumes only after several attempts.
    *
    * @param isMade whether a failing step is made, and only its answer is lost
    * @param runsAt the failing step at which another client lets the simulator run
    */
  private final class FragileStepper(
      stepper: SteppedTime,
      failing: Range,
      failedResumes: Int,
      stepsBy: Int => Option[Span],
      isMade: Boolean,
      runsAt: Option[Int]
  ) extends SteppedTime:
    private var steps, resumes = 0
    var pauses                 = 0
    var paused                 = false

    def pause(): Future[Either[VehicleError, Unit]] =
      pauses += 1
      paused = true
      stepper.pause()

    def resume(): Future[Either[VehicleError, Unit]] =
      resumes += 1
      if resumes <= failedResumes then Future.successful(lost)
      else
        paused = false
        stepper.resume()

    def continueFor(span: Span): Future[Either[VehicleError, Unit]] =
      steps += 1
      def made() = stepper.continueFor(stepsBy(steps).getOrElse(span))
      if runsAt.contains(steps) then stepper.resume().map(_ => lost)(using ExecutionContext.parasitic)
      else if !failing.contains(steps) then made()
      else if isMade then made().map(_ => lost)(using ExecutionContext.parasitic)
      else Future.successful(lost)

  private final case class FlightResult(
      outcome: FlightOutcome,
      paused: Boolean,
      hovering: Vector[Boolean],
      toldWhilePaused: Boolean,
      stoodStill: Boolean,
      commands: Int,
      ends: Int,
      drifts: Int
  )

  private val never = 0 until 0

  private def fly(
      failingReads: Range = never,
      failingSteps: Range = never,
      failedHovers: Int = 0,
      failedResumes: Int = 0,
      stepsBy: Int => Option[Span] = _ => None,
      isMade: Boolean = false,
      runsAt: Option[Int] = None,
      stopsAfter: Option[Span] = None
  ): FlightResult = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val scenario           = PaperDuel().fleet
      val world              = FarQuadrotors(scenario, LatencyProfile.none, 1, clock)
      val stepper            = FragileStepper(world, failingSteps, failedResumes, stepsBy, isMade, runsAt)
      val ports              = world.ports.map(Fragile(_, () => stepper.paused, failingReads, failedHovers))
      val recorder           = MemoryRecorder(Samples.heading)
      val team               = Team(scenario, ports, clock, recorder, LoopSettings())
      val flight = Flight.start(LoopKind.Paused, team, Some(stepper), Span.ofSeconds(1), clock, recorder)
      for span <- stopsAfter do system.scheduler.scheduleOnce(span.toDuration)(flight.stop())
      flight.outcome
        .map: outcome =>
          val recording = recorder.recording
          FlightResult(
            outcome,
            stepper.paused,
            ports.map(_.hovering),
            ports.exists(_.toldWhilePaused),
            stepper.pauses == 1 && !ports.exists(_.readWhileItRan),
            recording.commands.size,
            recording.acknowledgements.size,
            recording.events.count(_.kind == EventKind.StepDrift)
          )
    .value

  private def isReleased(landed: FlightResult): Unit =
    assert(!landed.paused, s"the simulator was left standing still: $landed")
    assertEquals(landed.hovering, Vector(true, true), landed.toString)
    assert(!landed.toldWhilePaused, s"to hover was commanded before the simulator ran again: $landed")
    assertEquals(landed.ends, landed.commands, landed.toString)

  test("after the last step the vehicles hover and the simulator runs"):
    val landed = fly()
    assertEquals((landed.outcome, landed.commands), (FlightOutcome.Completed, 20))
    assert(landed.stoodStill, "it was to be paused once, before anything was read")
    isReleased(landed)

  private def readAt(ms: Double*): Vector[Stamped[Unit]] =
    ms.toVector.map(at => Stamped((), Instant.Epoch + Span.ofMillis(at), Instant.Epoch, Instant.Epoch))

  test("a step is reported if its duration is wrong or time passed during its readings"):
    def drift(step: Long, before: Vector[Stamped[Unit]], read: Vector[Stamped[Unit]]) =
      PausedLoop.drift(step, before, read, Span.ofMillis(100))
    assertEquals(PausedLoop.newest(readAt(500, 503, 501)), Instant.Epoch + Span.ofMillis(503))
    assertEquals(drift(0, Vector.empty, readAt(500, 500)), Vector.empty)
    assertEquals(drift(1, readAt(500, 500), readAt(600, 600)), Vector.empty)
    val ran = "3.0 ms of simulator time passed while step 2 was read: it did not stand still"
    assertEquals(drift(2, readAt(500, 503), readAt(603, 600)), Vector(ran))
    for (at, ms) <- Seq(590.0 -> "90.0", 610.0 -> "110.0") do
      assertEquals(
        drift(7, readAt(500, 500), readAt(at, at)),
        Vector(s"step 7 took $ms ms of simulator time instead of 100.0 ms")
      )

  test(
    "steps of the right duration are recorded without drift, and steps of a wrong one with it"
  ):
    assertEquals(fly().drifts, 0)
    assertEquals(fly(stepsBy = _ => Some(Span.ofMillis(90))).drifts, 9)

  test(
    "an unanswered request is repeated, and a step is made once, whether it or its answer was lost"
  ):
    val truth = fly()
    for
      landed <- Seq(
        fly(failingReads = 5 to 12),
        fly(failingSteps = 5 to 12),
        fly(failingSteps = 1 to 3),
        fly(failingSteps = 5 to 5, isMade = true)
      )
    do
      assertEquals(landed.copy(stoodStill = true), truth)

  test("a simulator whose clock stops, runs back or leaps in a step ends the flight with that reason"):
    for
      (step, why) <- Seq(
        Span.Zero          -> "stood still in a step of 0.10 s",
        Span.ofMillis(-40) -> "ran back by 0.04 s in a step",
        Span.ofMillis(700) -> "advanced by 0.70 s in a step of 0.10 s"
      )
    do
      val landed = fly(stepsBy = number => Option.when(number == 4)(step))
      landed.outcome match
        case FlightOutcome.Failed(reason) => assert(reason.contains(why), reason)
        case other                        => fail(s"expected a failure, got $other")
      isReleased(landed)

  test("a flight ends if the simulator runs while it waits for it to stand still, and when it is stopped"):
    fly(runsAt = Some(5)).outcome match
      case FlightOutcome.Failed(reason) => assert(reason.contains("does not stand still"), reason)
      case other                        => fail(s"expected a failure, got $other")
    val stopped = fly(runsAt = Some(5), stopsAfter = Some(Span.ofSeconds(2)))
    assertEquals(stopped.outcome, FlightOutcome.Stopped)
    isReleased(stopped)

  private val forGood = 5 until 1_000_000

  test("a flight that fails during a reading or a step resumes the simulator, too"):
    for
      landed <- Seq(
        fly(failingReads = forGood),
        fly(failingSteps = forGood),
        fly(failingSteps = 1 until 1_000_000)
      )
    do
      landed.outcome match
        case FlightOutcome.Failed(reason) => assert(reason.contains("no answer"), reason)
        case other                        => fail(s"expected a failure, got $other")
      isReleased(landed)

  test("commands to vehicles and simulator are repeated until they answer"):
    isReleased(fly(failedHovers = 3))
    isReleased(fly(failingReads = forGood, failedHovers = 2, failedResumes = 4))

  test("a simulator that never answers again is given up, and the outcome states that"):
    fly(failedResumes = 999).outcome match
      case FlightOutcome.Failed(reason) => assert(reason.contains("stands still"), reason)
      case other                        => fail(s"expected a failure, got $other")
