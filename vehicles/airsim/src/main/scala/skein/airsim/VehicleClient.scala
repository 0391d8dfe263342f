package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.wire.*
import skein.rpc.{CallOptions, Channel, RpcError}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import upack.{Bool, Float32, Msg, Str}
import upickle.default.{Reader, writeMsg}

/** One vehicle of a simulator, of any kind. Positions are world NED in m, velocities NED in m/s.
  *
  * @param originNed origin of the vehicle's own frame in the world: its start
  * @param connectionKey vehicles with different keys are spread over the connections
  */
abstract class VehicleClient private[airsim] (
    client: AirSimClient,
    val name: String,
    val originNed: Vector3,
    connectionKey: Int
):
  private given ExecutionContext = ExecutionContext.parasitic

  protected val once: CallOptions   = CallOptions(client.timeout)
  protected val getter: CallOptions = once.copy(idempotent = true)
  private val sensors               = getter.copy(channel = Channel.Sensors)

  /** Options of calls that keep their order behind every command sent before on the connection. */
  protected val inOrder: CallOptions = once.copy(key = Some(connectionKey))

  val eyes: Eyes = Eyes(client, name, originNed)

  def over(client: AirSimClient, originNed: Vector3 = originNed, connectionKey: Int = 0): VehicleClient

  // ---- state

  /** The vehicle's state by its own estimate, with the times known so far. */
  def status(): Future[Either[RpcError, Stamped[VehicleStatus]]]

  def kinematics(): Future[Either[RpcError, Stamped[Kinematics]]] = status().map(_.map(_.map(_.kinematics)))

  /** The vehicle's true motion; AirSim does not state when it was valid. */
  def groundTruth(): Future[Either[RpcError, Kinematics]] =
    get[KinematicsState]("simGetGroundTruthKinematics").map(_.map(inWorld))

  def pose(): Future[Either[RpcError, VehiclePose]] =
    get[Pose]("simGetVehiclePose").map(_.map(pose =>
      VehiclePose(pose.position.toVector + originNed, pose.orientation.toQuaternion)
    ))

  /** Moves the vehicle to a pose. It keeps its velocity and its goal: a vehicle that holds a position flies
    * back to it; one that stood on the ground falls.
    */
  def setPose(pose: VehiclePose): Future[Either[RpcError, Unit]] =
    tell("simSetVehiclePose", own(pose), Bool(true))

  /** The collision since the last call, if there was one. */
  def collision(): Future[Either[RpcError, Option[Collision]]] =
    call[CollisionInfo]("simGetCollisionInfo", Seq(), once).map(_.map: info =>
      Option.when(info.has_collided)(
        Collision(info.time_stamp, info.position.toVector + originNed, info.normal.toVector, info.object_name)
      ))

  /** The vehicle's start in geographic coordinates. */
  def home(): Future[Either[RpcError, GeoLocation]] =
    get[GeoPoint]("getHomeGeoPoint").map(_.map(_.toLocation))

  // ---- sensors; an empty name means the first of its kind

  def imu(sensor: String = ""): Future[Either[RpcError, Stamped[ImuReading]]] =
    stamped("getImuData", Seq(Str(sensor)), sensors): (data: ImuData) =>
      val reading = ImuReading(
        data.orientation.toQuaternion,
        data.angular_velocity.toVector,
        data.linear_acceleration.toVector
      )
      (reading, data.time_stamp)

  def gps(sensor: String = ""): Future[Either[RpcError, Stamped[GpsReading]]] =
    stamped("getGpsData", Seq(Str(sensor)), sensors): (data: GpsData) =>
      val reading = GpsReading(data.gnss.geo_point.toLocation, data.gnss.velocity.toVector, data.is_valid)
      (reading, data.time_stamp)

  def barometer(sensor: String = ""): Future[Either[RpcError, Stamped[BarometerReading]]] =
    stamped("getBarometerData", Seq(Str(sensor)), sensors): (data: BarometerData) =>
      (BarometerReading(Metres(data.altitude), data.pressure), data.time_stamp)

  /** Magnetic field, body FRD, gauss. */
  def magnetometer(sensor: String = ""): Future[Either[RpcError, Stamped[Vector3]]] =
    stamped("getMagnetometerData", Seq(Str(sensor)), sensors): (data: MagnetometerData) =>
      (data.magnetic_field_body.toVector, data.time_stamp)

  // ---- control

  /** Takes or releases API control. Without it, moves answer true and do nothing. */
  def enableApiControl(on: Boolean = true): Future[Either[RpcError, Unit]] =
    tell("enableApiControl", Bool(on))

  def isApiControlEnabled(): Future[Either[RpcError, Boolean]] = get("isApiControlEnabled")

  /** Ends the current move with false. Keeps its order behind every command sent before on the connection. */
  def cancelLastTask(): Future[Either[RpcError, Unit]] =
    call[Msg]("cancelLastTask", Seq(), inOrder).map(_.map(_ => ()))

  /** Answers when every command sent before on the connection has reached the simulator. */
  def reached(): Future[Either[RpcError, Unit]] =
    client.rpc.call("ping", Seq(), inOrder).map(_.map(_ => ()))

  // ---- helpers

  protected def get[A: Reader](method: String): Future[Either[RpcError, A]] = call(method, Seq(), getter)

  protected def ask(method: String, params: Msg*): Future[Either[RpcError, Boolean]] =
    call(method, params, once)

  protected def tell(method: String, params: Msg*): Future[Either[RpcError, Unit]] =
    call[Msg](method, params, once).map(_.map(_ => ()))

  protected def call[A: Reader](
      method: String,
      params: Seq[Msg],
      options: CallOptions
  ): Future[Either[RpcError, A]] =
    client.rpc.callAs[A](method, params :+ Str(name), options)

  /** Calls a getter whose answer states when it was valid. */
  protected def stamped[A: Reader, B](
      method: String,
      params: Seq[Msg] = Seq(),
      options: CallOptions = getter
  )(
      read: A => (B, Instant)
  ): Future[Either[RpcError, Stamped[B]]] =
    client.rpc
      .callStampedAs[A](method, params :+ Str(name), options)
      .map(_.map: answer =>
        val (value, validAt) = read(answer.value)
        Stamped(value, validAt, answer.sentAt, answer.receivedAt))

  /** Calls for the state of a vehicle, whose numbers must be finite. */
  protected def stateOf[A: Reader, S <: VehicleStatus](method: String)(
      read: A => (S, Instant)
  ): Future[Either[RpcError, Stamped[S]]] = stamped(method)(read).map(_.filterOrElse(
    _.value.kinematics.isFinite,
    RpcError.Malformed(method, "expected finite numbers in kinematics_estimated")
  ))

  protected def own(pose: VehiclePose): Msg =
    writeMsg(Pose(pose.positionNed - originNed, pose.orientation))

  protected def inWorld(state: KinematicsState): Kinematics =
    Kinematics(
      state.position.toVector + originNed,
      state.linear_velocity.toVector,
      state.orientation.toQuaternion,
      state.angular_velocity.toVector
    )

  protected def real(value: Double): Msg = Float32(value.toFloat)

private object VehicleClient:

  /** Makes a client for a named vehicle.
    *
    * @param make builds it from its origin and its connection's key
    */
  def named[A](
      client: AirSimClient,
      name: String,
      make: (Vector3, Int) => A
  ): Future[Either[AirSimError, A]] =
    given ExecutionContext = ExecutionContext.parasitic
    client.vehicles().flatMap:
      case Left(error)                           => Future.successful(Left(AirSimError.Call(error)))
      case Right(names) if !names.contains(name) =>
        Future.successful(Left(AirSimError.UnknownVehicle(name, names)))
      case Right(names) =>
        client.settings().map(_.map: world =>
          val origin = world.vehicles.find(_.name == name).fold(Vector3.Zero)(_.startNed)
          make(origin, names.indexOf(name)))
