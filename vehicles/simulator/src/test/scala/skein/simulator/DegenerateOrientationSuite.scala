package skein.simulator

import skein.airsim.wire.{KinematicsState, Pose, Quaternionr, Vector3r}
import skein.units.*
import upack.{Bool, Str}
import upickle.default.writeMsg

/** Quaternions that are not of unit length, as clients send them by mistake: they are normalised. */
class DegenerateOrientationSuite extends munit.FunSuite:

  /** Greatest distance from its position within 10 s, m. */
  private def off(method: String, q: Quaternionr): Double =
    val bench = Bench().hovering(-20)
    bench.pass(1)
    val place = Vector3r(0, 0, -20)
    val still = Vector3r.Zero
    method match
      case "simSetKinematics" =>
        val state = KinematicsState(place, q, still, still, still, still)
        bench.tell(method, writeMsg(state), Bool(true), Str(""))
      case "simSetObjectPose" => bench.tell(method, Str("Evader"), writeMsg(Pose(place, q)), Bool(true))
      case _                  => bench.tell(method, writeMsg(Pose(place, q)), Bool(true), Str(""))
    (1 to 200).map { _ =>
      bench.pass(0.05)
      (bench.position() - Vector3(0, 0, -20)).norm
    }.max

  test("a vehicle placed with a quaternion of length 0 or 2 stays near its position"):
    for
      method    <- Seq("simSetVehiclePose", "simSetObjectPose", "simSetKinematics")
      (q, most) <- Seq(
        Quaternionr(0, 0, 0, 0)       -> 0.1,
        Quaternionr(2, 0, 0, 0)       -> 0.1,
        Quaternionr(0, 0, 0, 2)       -> 0.1,
        Quaternionr(1e-20f, 0, 0, 0)  -> 0.1,
        Quaternionr(1e30f, 0, 0, 0)   -> 0.1,
        Quaternionr(1.9f, 0.6f, 0, 0) -> 3.0
      )
    do
      val away = off(method, q)
      assert(away <= most, s"$method $q: $away m")

  test("a quaternion of length 2 has the effect of one of length 1, even upside down"):
    assertEquals(
      off("simSetVehiclePose", Quaternionr(1, 1, 1, 1)),
      off("simSetVehiclePose", Quaternionr(0.5f, 0.5f, 0.5f, 0.5f))
    )
