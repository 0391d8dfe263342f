package patience

import scala.concurrent.duration.*
import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.policy.*
import skein.signal.{Kinematics, LatencyProfile}
import skein.units.*

class PatienceSimulation extends munit.FunSuite:
  override val munitTimeout: Duration = 3.minutes

  private def seen(age: Span) =
    def at(north: Double, speed: Double) = Seen(
      Kinematics(Vector3(north, 0, -20), Vector3(speed, 0, 0), Quaternion.Identity, Vector3.Zero),
      age,
      isPredicted = false
    )
    Observation(
      self = 1,
      vehicles = Vector(at(18, 4), at(10, 0)),
      opponent = 0,
      headings = Vector(Radians(0), Radians(0)),
      elapsed = Span.ofMillis(100),
      decisions = 1,
      cruise = MetresPerSecond(10),
      startDown = Metres(-20)
    )

  test("a policy is a pure function: a fresh reading is followed at its speed, an old one more slowly"):
    val patient                           = Patient(metres = 8, trustS = 0.2)
    def northMps(age: Span, held: Double) = patient.choose(seen(age), held)._1 match
      case Action.Velocity(velocity, _) => velocity.x
      case other                        => fail(s"got $other")
    assertEqualsDouble(northMps(Span.Zero, 0), 4, 1e-9)
    assertEqualsDouble(northMps(Span.ofMillis(200), 0.2), 2, 1e-9)

  test("in flight it keeps the requested distance"):
    val result = VirtualFlights
      .result(Chase(), LoopKind.Predictive, LatencyProfile.vpn, seed = 1)
      .fold(fail(_), identity)
    assertEqualsDouble(result.value("last 10 s").get, 8, 3)
