package skein.flight

import skein.signal.{Kinematics, Stamped}
import skein.units.*

class DisplacementSuite extends munit.FunSuite:
  private def at(s: Double, north: Double, northMps: Double, down: Double = -20) =
    val time = Instant.Epoch + Span.ofSeconds(s)
    Stamped(
      Kinematics(Vector3(north, 0, down), Vector3(northMps, 0, 0), Quaternion.Identity, Vector3.Zero),
      time,
      time,
      time
    )

  private def displaced(from: Stamped[Kinematics], to: Stamped[Kinematics]) =
    Displacement.between("Evader", from, to).isDefined

  test("what flies evenly, brakes hard, bounces off a wall, or was not read for a while, is where it can be"):
    assert(!displaced(at(0, 0, 10), at(0.1, 1.0, 10)))
    assert(!displaced(at(0, 0, 10), at(0.1, 0.85, 7)))
    assert(!displaced(at(0, 0, 10), at(0.1, 0.2, -5)))
    assert(!displaced(at(0, 0, 0), at(2, 25, 20)))
    assert(!displaced(at(0, 0, 0), at(0, 0, 0)))

  test("a vehicle that was placed elsewhere, or reported another one's position, is recognised anywhere"):
    assert(displaced(at(0, 40, 10), at(0.1, 0, 0)), "reset")
    assert(displaced(at(0, 40, 10), at(0.1, 42.5, 10)), "a pose ahead")
    assert(displaced(at(0, 40, 10), at(0.1, 41, 10, down = -21)), "a pose above")
    assert(displaced(at(0, 0, 5), at(0.1, 9, 8)), "another vehicle's state")

  test("a clock that stands still allows no conclusion"):
    assert(!displaced(at(0, 0, 0), at(0, 3, 0)))
