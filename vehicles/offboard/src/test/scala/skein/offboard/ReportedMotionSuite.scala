package skein.offboard

import skein.mavlink.{AttitudeQuaternion, LocalPositionNed}

class ReportedMotionSuite extends munit.FunSuite:
  private def north(m: Float, bootMs: Long) = LocalPositionNed(bootMs, m, 0, 0, 0, 0, 0)

  test("a message that was overtaken is no new sample; a clock that begins anew is heard"):
    val (turned, _)    = ReportedMotion().heard(AttitudeQuaternion(60_000, 1, 0, 0, 0, 0, 0, 0))
    val (first, _)     = turned.heard(north(1, 60_000))
    val (late, isNew)  = first.heard(north(2, 59_500))
    val (anew, begins) = late.heard(north(3, 40))
    assert(!isNew && begins)
    assertEquals(anew.newest.map(_.state.positionNed.x), Some(3.0))
