package skein.flight

import skein.policy.{Action, Agent, Seen}
import skein.record.{LaterDecision, MemoryRecorder, Samples}
import skein.scenario.{Known, PaperDuel, Scenario}
import skein.signal.Kinematics
import skein.units.*

/** Ends when both vehicles are known to be less than 5 m apart. */
final case class Meeting() extends Scenario:
  def agents: Vector[Agent]                  = PaperDuel().agents
  override def isOver(known: Known): Boolean =
    val Vector(one, other) = known.vehicles.map(_.kinematics.positionNed): @unchecked
    (one - other).norm < 5

class EndConditionSuite extends munit.FunSuite:

  /** Whether a flight is over after two decisions, each by its own vehicle's controller: the second has not
    * heard of the first vehicle, which has left, for a second.
    */
  private def isOver(isDecentralised: Boolean): Boolean =
    val end = EndCondition(Meeting(), isPaused = false, isDecentralised, MemoryRecorder(Samples.heading))
    def seen(north: Double, ageMs: Double) = Seen(
      Kinematics(Vector3(north, 0, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero),
      Span.ofMillis(ageMs),
      isPredicted = false
    )
    def decide(vehicle: Int, atMs: Double, readings: Seen*) =
      val at = Instant.Epoch + Span.ofMillis(atMs)
      end.offer(LaterDecision(
        PaperDuel().agents(vehicle).name,
        at,
        Action.Hover,
        seesOthers = false,
        readings.toVector,
        Samples.decision(1)
      ))
    decide(0, 1000, seen(100, 50), seen(0, 1050))
    decide(1, 1010, seen(2, 1060), seen(0, 50))
    end.isOver.isCompleted

  test("with one controller, each decision's own readings end the scenario"):
    assert(isOver(isDecentralised = false))

  test("with a controller for each vehicle, a message of the past does not end the scenario for all"):
    assert(!isOver(isDecentralised = true))
