package skein.vehicle

import skein.units.Vector3

/** Compares the quadrotor with step responses and turns recorded from AirSim 1.8's own flight code (headless,
  * 3 ms, from rest at hover). The tolerance is 3 %; for altitudes it is 3 % of the excursion or 1 cm,
  * whichever is larger.
  */
class QuadrotorGolden extends munit.FunSuite:
  import QuadrotorGolden.*

  private val responses = Seq(
    Response(
      velocityZ = true,
      5,
      -20,
      Some(3.05),
      Some(9.70),
      Seq(0.69, 1.37, 2.42, 3.13, 3.94, 4.40, 4.51),
      4.58,
      -20.00,
      -19.86,
      9.5
    ),
    Response(
      velocityZ = true,
      10,
      -20,
      Some(3.21),
      None,
      Seq(1.23, 2.57, 4.69, 6.09, 7.58, 8.34, 8.49),
      8.57,
      -20.00,
      -19.44,
      18.4
    ),
    Response(
      velocityZ = true,
      5,
      -5,
      Some(1.48),
      Some(3.51),
      Seq(1.17, 2.36, 3.75, 4.34, 4.71, 4.78, 4.79),
      4.79,
      -5.00,
      -4.73,
      17.6
    ),
    Response(
      velocityZ = true,
      10,
      -5,
      Some(1.67),
      Some(4.40),
      Seq(1.59, 3.93, 7.10, 8.40, 9.10, 9.22, 9.22),
      9.22,
      -5.00,
      -3.95,
      30.5
    ),
    Response(
      velocityZ = false,
      5,
      -20,
      Some(0.86),
      Some(1.91),
      Seq(2.17, 3.45, 4.55, 4.80, 4.86, 4.86, 4.86),
      4.86,
      -21.05,
      -20.00,
      24.7
    ),
    Response(
      velocityZ = false,
      10,
      -20,
      Some(1.01),
      Some(2.29),
      Seq(2.82, 6.28, 8.71, 9.33, 9.48, 9.48, 9.48),
      9.48,
      -23.53,
      -20.00,
      32.7
    )
  )

  private val turns = Seq(
    Turn(velocityZ = true, 5, -20, 1.92, 2.55, 5.53, 3.29, 1.85, -20.18, -19.91),
    Turn(velocityZ = true, 10, -20, 1.88, 2.49, 5.38, 6.21, 1.77, -20.51, -19.62),
    Turn(velocityZ = true, 5, -5, 1.06, 1.36, 2.70, 3.39, 1.04, -5.27, -4.86),
    Turn(velocityZ = false, 5, -20, 0.53, 0.66, 1.45, 3.41, 0.54, -22.69, -21.05),
    Turn(velocityZ = false, 10, -20, 0.75, 0.87, 1.47, 6.29, 0.78, -27.08, -23.53)
  )

  for expected <- responses do
    test(s"${expected.name} from rest follows AirSim's step response"):
      val flight                = Flight(expected.velocityZ, expected.downM)
      val trace                 = flight.command(expected.speed, 0.0, StepSeconds)
      def timeTo(share: Double) = trace.find(_.speed >= share * expected.speed).map(_.timeS)
      close("t 63 %", timeTo(0.63), expected.t63)
      close("t 90 %", timeTo(0.90), expected.t90)
      for (atS, speed) <- Seq(0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 10.0).zip(expected.speeds) do
        close(s"speed after $atS s", trace((atS / Quadrotor.AirSimStepS).round.toInt - 1).speed, speed)
      close("final speed", trace.last.speed, expected.finalSpeed)
      altitudes(trace, expected.lowestDownM, expected.highestDownM)
      close("largest tilt, degrees", trace.map(_.tiltRad).max.toDegrees, expected.maxTiltDeg)

  for expected <- turns do
    test(s"${expected.name} turned by 90° follows AirSim's flight"):
      val flight = Flight(expected.velocityZ, expected.downM)
      flight.command(expected.speed, 0.0, StepSeconds)
      val trace                   = flight.command(0.0, expected.speed, StepSeconds)
      def timeTo(degrees: Double) = trace.find(_.directionRad.toDegrees >= degrees).map(_.timeS)
      close("t 45°", timeTo(45), Some(expected.t45))
      close("t 63 %", timeTo(0.63 * 90), Some(expected.t63))
      close("t 90 %", timeTo(0.90 * 90), Some(expected.t90))
      val slowest = trace.minBy(_.speed)
      close("smallest speed", slowest.speed, expected.minSpeed)
      close("time of the smallest speed", slowest.timeS, expected.minSpeedAtS)
      altitudes(trace, expected.lowestDownM, expected.highestDownM)

  private def altitudes(trace: Seq[Sample], lowestDownM: Double, highestDownM: Double): Unit =
    val tolerance = math.max(0.01, 0.01 * (highestDownM - lowestDownM)) + Printed
    assertEqualsDouble(trace.map(_.downM).min, lowestDownM, tolerance, "smallest z")
    assertEqualsDouble(trace.map(_.downM).max, highestDownM, tolerance, "largest z")

  private def close(what: String, actual: Option[Double], expected: Option[Double]): Unit =
    assertEquals(actual.isDefined, expected.isDefined, s"$what: $actual, expected $expected")
    for a <- actual; e <- expected do close(what, a, e)

  private def close(what: String, actual: Double, expected: Double): Unit =
    assertEqualsDouble(actual, expected, 0.01 * expected.abs + Printed, what)

object QuadrotorGolden:
  /** Half of the last printed digit of the reference. */
  private val Printed = 0.005

  /** Duration of each of a reference flight's two parts. It matters because altitudes drift slowly. Inferred:
    * all final speeds and altitudes are consistent with it.
    */
  private val StepSeconds = 14.0

  private final case class Response(
      velocityZ: Boolean,
      speed: Double,
      downM: Double,
      t63: Option[Double],
      t90: Option[Double],
      speeds: Seq[Double],
      finalSpeed: Double,
      lowestDownM: Double,
      highestDownM: Double,
      maxTiltDeg: Double
  ):
    def name = command(velocityZ, speed, downM)

  private final case class Turn(
      velocityZ: Boolean,
      speed: Double,
      downM: Double,
      t45: Double,
      t63: Double,
      t90: Double,
      minSpeed: Double,
      minSpeedAtS: Double,
      lowestDownM: Double,
      highestDownM: Double
  ):
    def name = command(velocityZ, speed, downM)

  private def command(velocityZ: Boolean, speed: Double, downM: Double) =
    s"${if velocityZ then "moveByVelocityZ" else "moveByVelocity"} $speed m/s at z = $downM"

  private final case class Sample(timeS: Double, vx: Double, vy: Double, downM: Double, tiltRad: Double):
    def speed        = math.hypot(vx, vy)
    def directionRad = math.atan2(vy, vx)

  private final class Flight(velocityZ: Boolean, downM: Double):
    private val state = Quadrotor.AirSim.hovering(Vector3(0, 0, downM))

    def command(northMps: Double, eastMps: Double, seconds: Double): Seq[Sample] =
      val setpoint =
        if velocityZ then Setpoint.velocityZ(northMps, eastMps, downM)
        else Setpoint.velocity(northMps, eastMps, 0)
      (1 to (seconds / Quadrotor.AirSimStepS).round.toInt).map: step =>
        Quadrotor.AirSim.step(state, setpoint)
        Sample(step * Quadrotor.AirSimStepS, state.vx, state.vy, state.z, state.tiltRad)
