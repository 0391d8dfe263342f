package skein.loop.learning

import skein.policy.*
import skein.signal.Kinematics
import skein.units.*

class LearningPolicySuite extends munit.FunSuite:
  private val shape = LearnedPolicy.shape(Vector(2))

  private def seen(decision: Long, elapsedMs: Double) =
    def at(north: Double) = Seen(
      Kinematics(Vector3(north, 0, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero),
      Span.Zero,
      isPredicted = false
    )
    Observation(
      0,
      Vector(at(0), at(20.0 + decision.toDouble)),
      1,
      Vector(Radians(0), Radians(0)),
      Span.ofMillis(elapsedMs),
      decision,
      MetresPerSecond(5),
      Metres(-20)
    )

  /** Distances at the ends of the transitions that are learned. */
  private def learned(calls: LearningPolicy => Unit): Vector[Double] =
    val taught  = Vector.newBuilder[Double]
    val lessons = new Lessons:
      def news(decision: Long): Vector[LearnerUpdate] = Vector.empty
      def flown(transition: Transition): Unit         = taught += transition.distanceM
    val untaught = LearnedPolicy(shape, Vector.fill(shape.parameters)(0.0), 3, 0)
    calls(LearningPolicy(untaught, _ => untaught, 0, 1, lessons, Span.ofMillis(100), (_, _) => ()))
    taught.result()

  /** Decides in turn, each time after `elapsedMs`. */
  private def decide(policy: LearningPolicy, elapsedMs: Double*) =
    elapsedMs.zipWithIndex.foldLeft(policy.start):
      case (memory, (ms, decision)) => policy.choose(seen(decision, ms), memory)._2

  test("what happens in a pause is not learned"):
    assertEquals(learned(decide(_, 0, 100, 5000, 100): Unit), Vector(21.0, 23.0))

  test("a loop that decides less often than once in two periods learns, but not from a pause"):
    assertEquals(learned(decide(_, 0, 250, 270, 5000, 260): Unit), Vector(22.0, 24.0))

  test("a late call and the next one, with one number, teach one transition"):
    val transitions = learned: policy =>
      val memory = decide(policy, 0, 100)
      // The first answer comes too late: its memory is discarded.
      for elapsedMs <- Seq(100.0, 200.0) do policy.choose(seen(2, elapsedMs), memory): Unit
    assertEquals(transitions, Vector(21.0, 22.0))
