package skein.forward

import skein.policy.Action

class SteppedVehicleSuite extends munit.FunSuite:
  test("every part of a reading is rounded to 32-bit floats"):
    val vehicle = new SteppedVehicle:
      protected def sinceStepS: Double                 = 0
      def start(x: Double, y: Double, z: Double): Unit = ()
      def act(action: Action): Unit                    = ()
      def advance(timeS: Double): Unit                 =
        state.x = 0.1
        state.vy = 0.2
        state.qw = 0.3
        state.wz = 0.4
    vehicle.advance(0)
    val seen = vehicle.seen
    assertEquals(
      Vector(seen.positionNed.x, seen.velocityNed.y, seen.orientation.w, seen.angularVelocityFrd.z),
      Vector(0.1f, 0.2f, 0.3f, 0.4f).map(_.toDouble)
    )
