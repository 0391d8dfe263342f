package skein.policy

import skein.signal.Kinematics
import skein.units.*

class WeaveSuite extends munit.FunSuite:
  private val weave = Weave(speedMps = 6, turnRadps = 0.8, leastS = 1, mostS = 4, course = 2)

  private def seen(elapsedS: Double, downM: Double = -20) = Observation(
    0,
    Vector(Seen(
      Kinematics(Vector3(0, 0, downM), Vector3.Zero, Quaternion.Identity, Vector3.Zero),
      Span.Zero,
      isPredicted = false
    )),
    0,
    Vector(Radians(0)),
    Span.ofSeconds(elapsedS),
    0,
    MetresPerSecond(6),
    Metres(-20)
  )

  private def headings(weave: Weave, periodS: Double): Vector[Double] =
    Iterator
      .iterate((weave.start, 0))((arc, made) =>
        (weave.choose(seen(if made == 0 then 0 else periodS), arc)._2, made + 1)
      )
      .drop(1)
      .take((60 / periodS).toInt)
      .map(_._1.headingRad)
      .toVector

  test(
    "the leader turns at its rate, left and right in turn, for times between the shortest and the longest"
  ):
    val turns = headings(weave, 0.01).sliding(2).map(pair => pair(1) - pair(0)).toVector
    // In a step in which an arc ends, it turns both ways.
    assert(turns.forall(math.abs(_) < 0.008 + 1e-9))
    assert(turns.count(turn => math.abs(math.abs(turn) - 0.008) < 1e-9) > turns.size * 0.99)
    val changes = turns.indices.tail.filter(i => turns(i) * turns(i - 1) < 0).map(_ * 0.01)
    val arcs    = changes.sliding(2).map(pair => pair(1) - pair(0)).toVector
    assert(arcs.size > 15, s"${arcs.size} arcs in a minute")
    assert(arcs.forall(arc => arc > 0.98 && arc < 4.02), arcs.toString)
    assert(arcs.max > 3 && arcs.min < 2, arcs.toString)

  test("the path does not depend on the period, but on the number of the course"):
    val (often, seldom) = (headings(weave, 0.05), headings(weave, 0.1))
    val apart           = seldom.indices.map(i => math.abs(seldom(i) - often(2 * i))).max
    assert(apart < 1e-6, s"$apart rad")
    assertNotEquals(headings(weave, 0.1), headings(weave.copy(course = 3), 0.1))

  test("the leader holds its altitude"):
    def downMps(downM: Double) = weave.choose(seen(0, downM), weave.start)._1 match
      case Action.Velocity(velocity, _) => velocity.z
      case other                        => fail(other.toString)
    assertEquals((downMps(-20), downMps(-19.5), downMps(-40)), (0.0, -0.5, 2.0))

  test("the follower commands the leader's velocity plus a velocity towards its place"):
    def state(north: Double, east: Double, mps: Double) =
      Seen(
        Kinematics(Vector3(north, east, -20), Vector3(mps, 0, 0), Quaternion.Identity, Vector3.Zero),
        Span.Zero,
        isPredicted = false
      )
    val at = seen(0).copy(
      self = 1,
      vehicles = Vector(state(10, 0, 4), state(9, 5, 4)),
      headings = Vector.fill(2)(Radians(0))
    )
    val keep = Shadowing(0, 0, 5, mostMps = 12, Pursuit(perS = 0.5, lead = 1))
    keep.choose(at, ())._1 match
      case Action.Velocity(velocity, _) =>
        assertEqualsDouble(velocity.x, 4.5, 1e-9)
        assertEqualsDouble(velocity.y, 0, 1e-9)
      case other => fail(other.toString)
