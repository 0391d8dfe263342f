package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

class NoisySensorSuite extends munit.FunSuite:
  private val truth = Kinematics(Vector3(1, 2, -3), Vector3(4, 5, 6), Quaternion.ofYaw(0.5), Vector3.Zero)

  private def noise(text: String): SensorNoise = SensorNoise.parse(text).fold(fail(_), identity)

  private def sensor(text: String, seed: Long = 1) = NoisySensor(noise(text), seed)

  private def sd(values: Seq[Double]) = math.sqrt(values.map(x => x * x).sum / values.size)

  test("white noise has the stated deviations, also of the heading, and leaves the attitude"):
    val noisy = sensor("position=0.5,velocity=0.1,heading=0.02")
    val tilt  =
      truth.copy(orientation = Quaternion.ofYaw(0.5) * Quaternion(math.cos(0.1), math.sin(0.1), 0, 0))
    val read = (0 until 20_000).map(i => noisy.read(tilt, Span.ofMillis(i)))
    for axis <- Seq[Vector3 => Double](_.x, _.y, _.z) do
      assertEqualsDouble(sd(read.map(one => axis(one.positionNed - truth.positionNed))), 0.5, 0.01)
      assertEqualsDouble(sd(read.map(one => axis(one.velocityNed - truth.velocityNed))), 0.1, 0.002)
    assertEqualsDouble(sd(read.map(_.orientation.yawRad - tilt.orientation.yawRad)), 0.02, 0.0005)
    assert(read.forall(one => math.abs(one.orientation.rollRad - 0.2) < 1e-9))
    val errors = read.map(_.positionNed.x - 1)
    assertEqualsDouble(errors.zip(errors.tail).map(_ * _).sum / errors.size, 0, 0.01)

  test("drift has the stated deviation, and correlates as e^(−t/T)"):
    val drifting = sensor("drift=2/10s")
    val errors   = (0 until 400_000).map(i => drifting.read(truth, Span.ofMillis(500 * i)).positionNed.y - 2)
    def correlation(steps: Int) = errors.zip(errors.drop(steps)).map(_ * _).sum / errors.size / 4
    assertEqualsDouble(sd(errors), 2, 0.05)
    for seconds <- Seq(1, 5, 10, 20) do
      assertEqualsDouble(correlation(2 * seconds), math.exp(-seconds / 10.0), 0.04, s"after $seconds s")

  test(
    "equal seeds give equal readings at equal times, however often they are read; other seeds give others"
  ):
    def at(seed: Long, times: Seq[Int]) =
      val noisy = sensor("position=1,velocity=1,heading=1,drift=1/5s,dropout=30%,outage=1s/3s", seed)
      times.map(ms => ms -> (noisy.isMissing(Span.ofMillis(ms)), noisy.read(truth, Span.ofMillis(ms)))).toMap
    val all = at(1, 0 to 20_000 by 7)
    val few = at(1, 0 to 20_000 by 49)
    assertEquals(few, all.filter((ms, _) => few.contains(ms)))
    assert(all.values.zip(at(2, 0 to 20_000 by 7).values).forall((one, other) => one._2 != other._2))

  test("the stated share of readings is missing, and all of them during outages"):
    val dropping = sensor("dropout=20%")
    assertEqualsDouble(
      (0 until 20_000).count(i => dropping.isMissing(Span.ofMillis(i))) / 20_000.0,
      0.2,
      0.012
    )
    val out   = sensor("outage=1s/10s")
    val gone  = (0 until 100_000).map(i => out.isMissing(Span.ofMillis(10 * i)))
    val edges = gone.zip(gone.tail).count(_ != _)
    assert(!gone.head)
    assertEqualsDouble(gone.count(identity) / 100_000.0, 0.1, 0.03)
    assertEqualsDouble(edges / 2.0, 100, 30)

  test("a mistake is one line that says what was expected"):
    for
      (text, expected) <- Seq(
        "position=-1"   -> "expected a number from 0.0 to 100.0, got 'position=-1'",
        "drift=1"       -> s"expected ${SensorNoise.forms}; got 'drift=1'",
        "drift=1/60"    -> "expected times from 0.1s on, got 'drift=1/60'",
        "dropout=95%"   -> "expected a share from 0% to 90%, got 'dropout=95%'",
        "outage=8s/60s" ->
          "expected at most 5 s, and a longer time from one to the next, got 'outage=8s/60s'",
        "position=1,position=2" -> "position stands twice"
      )
    do assertEquals(SensorNoise.parse(text).left.getOrElse("was taken"), expected)
