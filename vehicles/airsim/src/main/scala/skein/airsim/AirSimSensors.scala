package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.port.{Sensor, VehicleError}
import skein.rpc.RpcError
import skein.signal.Stamped
import skein.units.*

/** A vehicle's first sensor of each kind, as numbers. */
private object AirSimSensors:

  def of(vehicle: VehicleClient): Map[String, Sensor] = Map(
    "imu" -> sensor(vectors("angularVelocityFrd", "RadPerS") ++ vectors("specificForceFrd", "Mps2"))(
      vehicle.imu(),
      imu => numbers(imu.angularVelocityFrd) ++ numbers(imu.specificForceFrd)
    ),
    "gps" -> sensor(Vector("latitudeDeg", "longitudeDeg", "altitudeM") ++ vectors("velocityNed", "Mps"))(
      vehicle.gps(),
      gps =>
        Vector(gps.location.latitudeDeg, gps.location.longitudeDeg, gps.location.altitude.value) ++
          numbers(gps.velocityNed)
    ),
    "barometer" -> sensor(Vector("altitudeM", "pressurePa"))(
      vehicle.barometer(),
      barometer => Vector(barometer.altitude.value, barometer.pressurePa)
    ),
    "magnetometer" -> sensor(vectors("fieldFrd", "Gauss"))(vehicle.magnetometer(), numbers)
  )

  private def sensor[A](names: Vector[String])(
      ask: => Future[Either[RpcError, Stamped[A]]],
      values: A => Vector[Double]
  ): Sensor = new Sensor:
    def columns: Vector[String]                                       = names
    def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] =
      ask.map(_.left.map(VehicleErrors.errorOf).map(_.map(value => IArray.from(values(value)))))(using
        ExecutionContext.parasitic
      )

  private def vectors(name: String, unit: String) = Vector("X", "Y", "Z").map(axis => s"$name$axis$unit")

  private def numbers(vector: Vector3) = Vector(vector.x, vector.y, vector.z)
