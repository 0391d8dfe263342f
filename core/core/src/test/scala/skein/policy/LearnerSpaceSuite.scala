package skein.policy

import skein.signal.Kinematics
import skein.units.*

class LearnerSpaceSuite extends munit.FunSuite:
  import LearnerSpace.{Climbing, Level}

  private def at(northM: Double, downM: Double, downMps: Double) = Seen(
    Kinematics(Vector3(northM, 2, downM), Vector3(3, 0, downMps), Quaternion.Identity, Vector3.Zero),
    Span.ofMillis(50),
    isPredicted = false
  )

  /** This vehicle climbs by 1 m/s at 10 m altitude; 8 m ahead, its opponent sinks by 2 m/s at 25 m. */
  private val seen = Observation(
    self = 0,
    vehicles = Vector(at(0, -10, -1), at(8, -25, 2)),
    opponent = 1,
    headings = Vector(Radians(0), Radians(0)),
    elapsed = Span.ofMillis(100),
    decisions = 3,
    cruise = MetresPerSecond(4),
    startDown = Metres(-12)
  )

  test("a learner that climbs observes what a level one does, and then heights and vertical speeds, up"):
    assertEquals(
      Climbing.observe(seen).toVector,
      Level.observe(seen).toVector ++ Vector(15.0, -3.0, 10.0, 1.0)
    )
    for space <- Seq(Level, Climbing) do
      assertEquals(space.observe(seen).length, space.inputs)
      assertEquals(space.scales.size, space.inputs)

  test("an action turns to the right, and keeps the start's altitude or climbs"):
    assertEquals(Level.action(seen, 0.25, 0), Action.Along(Radians(0.25), MetresPerSecond(4), Metres(-12)))
    val (north, east) = (4 * StrictMath.cos(0.25), 4 * StrictMath.sin(0.25))
    assertEquals(Climbing.action(seen, 0.25, 1.5), Action.Velocity(Vector3(north, east, -1.5)))

  test("a family of networks that climb has their greatest vertical speed as its last parameter"):
    val family = PolicyFamily.parse("climbing:").fold(fail(_), identity)
    assertEquals(family.space.axes.map(_.name).takeRight(3), Vector("turnRateRadPerS", "turnRad", "climbMps"))
    // The second output is a tenth of the opponent's height.
    val weights = Vector.fill(14)(0.0) ++ (0 until 14).map(input => if input == 9 then 2.0 else 0)
    val policy  = family.policy(weights ++ Vector(1.0, 0.0, 5.0))
    val Action.Velocity(velocity, _) = policy.choose(seen, policy.start)._1: @unchecked
    assertEquals(velocity.x, 4.0)
    assertEqualsDouble(velocity.z, -5 * StrictMath.tanh(1.5), 1e-12)
    assert(!policy.isPlanar && policy.isAgainstOne)
    assertEquals(PolicyFamily.parse(family.name).map(_.name), Right(family.name))
