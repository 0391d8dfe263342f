package skein.policy

import skein.signal.Kinematics
import skein.units.*

class DynamicWindowSuite extends munit.FunSuite:
  private val window  = DynamicWindow("lidar", 0, 0, Radians(0), 5)
  private val columns = Vector("northM", "eastM", "downM") ++ Vector.tabulate(120)(i => f"range${i * 3}%03dM")

  private def scan(nearM: Double => Double, age: Span = Span.ofMillis(50)) = Map(
    "lidar" -> Sensed(columns, Vector(0.0, 0.0, -4.0) ++ Vector.tabulate(120)(i => nearM(3 * i + 1.5)), age)
  )

  private def choose(
      sensed: Map[String, Sensed],
      position: Vector3 = Vector3(0, 0, -4),
      velocity: Vector3 = Vector3(5, 0, 0)
  ) =
    val own = Kinematics(position, velocity, Quaternion.Identity, Vector3.Zero)
    window
      .choose(
        Observation(
          0,
          Vector(Seen(own, Span.Zero, isPredicted = false)),
          0,
          Vector(Radians(0)),
          Span.ofMillis(100),
          1,
          MetresPerSecond(5),
          Metres(-4),
          sensed
        ),
        ()
      )
      ._1 match
      case along: Action.Along => along
      case other               => fail(s"got $other")

  test("without obstacles the vehicle flies straight on at its cruise speed"):
    assertEquals(choose(scan(_ => 40)), Action.Along(Radians(0), MetresPerSecond(5), Metres(-4)))

  test("without a scan, or with an old one, the vehicle stands still"):
    assertEquals(choose(Map.empty).speed, MetresPerSecond(0))
    assertEquals(choose(scan(_ => 40, Span.ofSeconds(1))).speed, MetresPerSecond(0))

  test("the vehicle passes a tree on its right on the left, and one on its left on the right"):
    val right = choose(scan(deg => if deg > 0 && deg < 6 then 7 else 40))
    val left  = choose(scan(deg => if deg > 354 then 7 else 40))
    assert(right.heading.value < 0, s"$right")
    assert(left.heading.value > 0, s"$left")

  test("before a wall across its lane the vehicle slows down and turns along it"):
    val wall  = (deg: Double) => 4 / StrictMath.cos(StrictMath.toRadians(deg)).max(1e-9)
    val chose = choose(scan(deg => if deg < 80 || deg > 280 then wall(deg).min(40) else 40))
    val onto  = chose.speed.value * StrictMath.cos(chose.heading.value)
    assert(onto < 2.5, s"$chose")

  test("beside its lane the vehicle returns at an angle, not straight across"):
    val chose = choose(scan(_ => 40), position = Vector3(0, 5, -4))
    assertEqualsDouble(chose.heading.value, -StrictMath.atan2(5, 10), 0.1)

  test("points of a scan are assumed to stay in place while the vehicle flies on"):
    // Seen from 0, a tree at 10 m: from 12 m north it lies behind.
    val tree = scan(deg => if deg < 3 || deg > 357 then 10 else 40)
    assertEquals(
      choose(tree, position = Vector3(12, 0, -4)),
      Action.Along(Radians(0), MetresPerSecond(5), Metres(-4))
    )
