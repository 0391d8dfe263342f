package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.policy.Action
import skein.port.{SteppedTime, VehicleError, VehiclePort}
import skein.record.{MemoryRecorder, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

class PausedLoopSuite extends munit.FunSuite:
  private val lost = Left(VehicleError.TimedOut("lost: no answer within 500 ms"))

  /** A vehicle whose reading number `failing` fails, and whose first hovers do. */
  private final class Fragile(craft: VehiclePort, isPaused: () => Boolean, failing: Int, failedHovers: Int)
      extends VehiclePort:
    private var reads, hovers = 0
    var hovering              = false
    var toldWhilePaused       = false

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      reads += 1
      if reads == failing then Future.successful(lost) else craft.read()

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      hovering = false
      craft.act(action, lasts)

    def hover(): Future[Either[VehicleError, Boolean]] =
      hovers += 1
      toldWhilePaused ||= isPaused()
      if hovers <= failedHovers then Future.successful(lost)
      else
        hovering = true
        craft.hover()

  /** A simulator whose step number `failing` fails, and which answers only after so many times that it is let run. */
  private final class FragileStepper(stepper: SteppedTime, failing: Int, failedResumes: Int)
      extends SteppedTime:
    private var steps, resumes = 0
    var paused                 = false

    def pause(): Future[Either[VehicleError, Unit]] =
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
      if steps == failing then Future.successful(lost) else stepper.continueFor(span)

  private final case class FlightResult(
      outcome: Outcome,
      paused: Boolean,
      hovering: Vector[Boolean],
      toldWhilePaused: Boolean,
      commands: Int,
      ends: Int
  )

  private def fly(
      failingRead: Int = 0,
      failingStep: Int = 0,
      failedHovers: Int = 0,
      failedResumes: Int = 0
  ): FlightResult = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val scenario           = PaperDuel().fleet
      val world              = FarQuadrotors(scenario, LatencyProfile.none, 1, clock)
      val stepper            = FragileStepper(world, failingStep, failedResumes)
      val crafts             = world.crafts.map(Fragile(_, () => stepper.paused, failingRead, failedHovers))
      val recorder           = MemoryRecorder(Samples.heading)
      val team               = Team(scenario, crafts, clock, recorder, LoopSettings())
      Flight
        .start(LoopKind.Paused, team, Some(stepper), Span.ofSeconds(1), clock, recorder)
        .outcome
        .map: outcome =>
          val recording = recorder.recording
          FlightResult(
            outcome,
            stepper.paused,
            crafts.map(_.hovering),
            crafts.exists(_.toldWhilePaused),
            recording.commands.size,
            recording.acknowledgements.size
          )
    .value

  private def isReleased(landed: FlightResult): Unit =
    assert(!landed.paused, s"the simulator was left standing still: $landed")
    assertEquals(landed.hovering, Vector(true, true), landed.toString)
    assert(!landed.toldWhilePaused, s"to hover was commanded before the simulator ran again: $landed")
    assertEquals(landed.ends, landed.commands, landed.toString)

  test("after its last step the vehicles hover and the simulator runs"):
    val landed = fly()
    assertEquals((landed.outcome, landed.commands), (Outcome.Completed, 20))
    isReleased(landed)

  test("a flight that fails midway, in a reading or in a step, lets the simulator run, too"):
    for landed <- Seq(fly(failingRead = 5), fly(failingStep = 5), fly(failingStep = 1)) do
      landed.outcome match
        case Outcome.Failed(reason) => assert(reason.contains("no answer"), reason)
        case other                  => fail(s"expected a failure, came $other")
      isReleased(landed)

  test("vehicles and simulator are told again until they answer"):
    isReleased(fly(failedHovers = 3))
    isReleased(fly(failingRead = 5, failedHovers = 2, failedResumes = 4))

  test("a simulator that never answers again is given up, and the outcome says so"):
    fly(failedResumes = 999).outcome match
      case Outcome.Failed(reason) => assert(reason.contains("stands still"), reason)
      case other                  => fail(s"expected a failure, came $other")
