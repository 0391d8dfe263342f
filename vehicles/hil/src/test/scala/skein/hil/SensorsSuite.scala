package skein.hil

import skein.signal.Kinematics
import skein.units.*

object SensorsSuite:
  private[hil] val home = GeoLocation(47.641468, -122.140165, Metres(122))

  /** The true state of a vehicle at rest, at a time since the start. */
  private[hil] def atRest(up: Span, velocityNed: Vector3 = Vector3.Zero): SensorTruth = SensorTruth(
    Instant.ofNanos(1_000_000_000_000L) + up,
    up,
    Kinematics(Vector3.Zero, velocityNed, Quaternion.Identity, Vector3.Zero),
    Vector3.Zero,
    home,
    99_863,
    287.4
  )

class SensorsSuite extends munit.FunSuite:
  import SensorsSuite.*

  private def spread(values: Seq[Double]) =
    val mean = values.sum / values.size
    (mean, math.sqrt(values.map(value => (value - mean) * (value - mean)).sum / values.size))

  test("a sensor without noise measures true values"):
    val sensors = Sensors(1, SensorNoise.None)
    val truth   = atRest(Span.ofSeconds(1))
    val shown   = sensors.inertial(truth, 0.004)
    assertEquals(shown, Sensors.Inertial(Vector3(0, 0, -9.80665), Vector3.Zero))
    assertEquals(sensors.pressurePa(truth), truth.pressurePa)
    assertEquals(sensors.magneticFrd(truth), MagneticField.ned(home))
    assertEquals(sensors.fix(truth).place, home)

  test("noise has the stated size, independent of the rate of readings"):
    for rate <- Seq(250, 1000) do
      val noise   = SensorNoise()
      val sensors = Sensors(7)
      val shown   = Vector.tabulate(20_000)(tick =>
        sensors.inertial(atRest(Span.ofSeconds(tick.toDouble / rate)), 1.0 / rate)
      )
      val (force, forceNoise) = spread(shown.map(_.specificForceFrd.x))
      val (rates, ratesNoise) = spread(shown.map(_.angularVelocityFrd.z))
      assertEqualsDouble(forceNoise, noise.accelMps2PerRootHz * math.sqrt(rate), forceNoise * 0.03)
      assertEqualsDouble(ratesNoise, noise.gyroRadpsPerRootHz * math.sqrt(rate), ratesNoise * 0.03)
      assert(force.abs < 0.005 && rates.abs < 1e-4, s"at $rate Hz: $force m/s², $rates rad/s")

  test("satellite fixes wander within centimetres, pressure within decimetres in a minute"):
    val sensors   = Sensors(3)
    val fixes     = Vector.tabulate(480)(tick => sensors.fix(atRest(Span.ofMillis(125.0 * tick))))
    val (_, east) = spread(fixes.map(_.place.nedFrom(home).y))
    assertEqualsDouble(east, 0.016 / math.sqrt(1 - 0.76 * 0.76), 0.006)
    val pressures     = Vector.tabulate(3000)(tick => sensors.pressurePa(atRest(Span.ofMillis(20.0 * tick))))
    val (first, last) = (pressures.take(500).sum / 500, pressures.takeRight(500).sum / 500)
    assert((first - last).abs < 12, s"$first Pa, then $last Pa")

  test("equal seeds give equal readings, different seeds different ones"):
    def shown(seed: Long) =
      val sensors = Sensors(seed)
      Vector.tabulate(100)(tick => sensors.inertial(atRest(Span.ofMillis(4.0 * tick)), 0.004))
    assertEquals(shown(5), shown(5))
    assert(shown(5) != shown(6))
