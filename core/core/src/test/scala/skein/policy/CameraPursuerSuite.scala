package skein.policy

import skein.scenario.Eye
import skein.signal.Kinematics
import skein.units.*

class CameraPursuerSuite extends munit.FunSuite:
  private val start   = Vector3(21, 0, -20)
  private val pursuer = CameraPursuer(PurePursuit(turnRateRadPerS = 1000), Some("evader"), start)

  private def at(positionNed: Vector3, velocityNed: Vector3 = Vector3.Zero, isPredicted: Boolean = false) =
    Seen(Kinematics(positionNed, velocityNed, Quaternion.Identity, Vector3.Zero), Span.Zero, isPredicted)

  /** The decision of a pursuer at the origin, when the evader is actually 5 m to the west. */
  private def chosen(
      policy: CameraPursuer,
      sensed: Map[String, Sensed],
      isPredicted: Boolean = false
  ): (heading: Double, yaw: Yaw) =
    val seen = Observation(
      1,
      Vector(at(Vector3(0, -5, -20)), at(Vector3(0, 0, -20), isPredicted = isPredicted)),
      0,
      Vector(Radians(0), Radians(0)),
      Span.ofMillis(100),
      1,
      MetresPerSecond(10),
      Metres(-20),
      sensed,
      actsIn = Span.ofMillis(200)
    )
    policy.choose(seen, ())._1 match
      case Action.VelocityAt(north, east, down, yaw) =>
        assertEqualsDouble(StrictMath.hypot(north, east), 10, 1e-9)
        assertEquals(down, Metres(-20))
        (StrictMath.atan2(east, north), yaw)
      case other => fail(s"$other")

  /** An estimate of the evader 8 m to the north, moving east at 5 m/s. */
  private def belief(age: Span) = Map(
    "evader" -> Sensed(Eye.Columns, Vector(8.0, 0, -20, 0, 5, 0) ++ Vector.fill(14)(0.0), age)
  )

  test("with a reading of its opponent, the pursuer flies there and points its camera there"):
    val told = chosen(pursuer.copy(sensor = None), Map.empty)
    assertEqualsDouble(told.heading, -math.Pi / 2, 1e-9)
    assertEquals(told.yaw, Yaw.Towards(Radians(told.heading)))

  test(
    "with its camera alone, the pursuer flies to the opponent's start, then to the estimate, not to the " +
      "true position"
  ):
    assertEqualsDouble(chosen(pursuer, Map.empty).heading, 0, 1e-9)
    assertEqualsDouble(chosen(pursuer, belief(Span.ofMillis(300))).heading, 0, 1e-9)

  test(
    "if the pursuer's own position is predicted, the estimate is predicted for the time of the command"
  ):
    val ahead = chosen(pursuer, belief(Span.ofMillis(300)), isPredicted = true)
    assertEqualsDouble(ahead.heading, StrictMath.atan2(5 * 0.5, 8), 1e-9)
    // An opponent that was lost long ago is looked for where it was then expected, not ever farther away.
    val long = chosen(pursuer, belief(Span.ofSeconds(60)), isPredicted = true)
    assertEqualsDouble(long.heading, StrictMath.atan2(5 * 1.5, 8), 1e-9)
