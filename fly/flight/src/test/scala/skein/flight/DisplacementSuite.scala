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

  test("steady flight, hard braking, a bounce off a wall and a gap in the readings are not displacements"):
    assert(!displaced(at(0, 0, 10), at(0.1, 1.0, 10)))
    assert(!displaced(at(0, 0, 10), at(0.1, 0.85, 7)))
    assert(!displaced(at(0, 0, 10), at(0.1, 0.2, -5)))
    assert(!displaced(at(0, 0, 0), at(2, 25, 20)))
    assert(!displaced(at(0, 0, 0), at(0, 0, 0)))

  test("a vehicle that was placed elsewhere, or reports another vehicle's position, is detected"):
    assert(displaced(at(0, 40, 10), at(0.1, 0, 0)), "reset")
    assert(displaced(at(0, 40, 10), at(0.1, 42.5, 10)), "a pose ahead")
    assert(displaced(at(0, 40, 10), at(0.1, 41, 10, down = -21)), "a pose above")
    assert(displaced(at(0, 0, 5), at(0.1, 9, 8)), "another vehicle's state")

  test("a clock that stands still allows no conclusion"):
    assert(!displaced(at(0, 0, 0), at(0, 3, 0)))
