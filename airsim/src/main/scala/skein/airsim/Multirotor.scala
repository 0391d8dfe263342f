package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.wire.*
import skein.rpc.{CallOptions, Channel, RpcError}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import upack.{Bool, Float32, Float64, Int32, Msg, Str}
import upickle.default.{Reader, writeMsg}

/** One multirotor of a simulator. Positions are world NED in m, velocities NED in m/s.
  *
  * A move answers when it has ended: true if it was flown to its end, false if a newer one replaced it or its time was
  * over. All moves of one vehicle share a connection, so that none overtakes another. AirSim holds a worker for each
  * move until it ends: have at most one under way and the one that replaces it.
  *
  * @param originNed
  *   where the vehicle's own frame has its origin: its start
  * @param connectionKey
  *   vehicles with different keys are spread over the connections
  */
final class Multirotor(
    client: AirSimClient,
    val name: String,
    val originNed: Vector3 = Vector3.Zero,
    connectionKey: Int = 0
) extends AttitudeMoves:
  private given ExecutionContext = ExecutionContext.parasitic

  private val once   = CallOptions(client.timeout)
  private val getter = once.copy(idempotent = true)
  private val sensor = getter.copy(channel = Channel.Sensors)

  /** Its cameras and LIDARs. */
  val eyes: Eyes = Eyes(client, name, originNed)

  // ---- state

  /** Where the vehicle is and how it moves, by its own estimate, with the three times known so far. */
  def kinematics(): Future[Either[RpcError, Stamped[Kinematics]]] = status().map(_.map(_.map(_.kinematics)))

  def status(): Future[Either[RpcError, Stamped[MultirotorStatus]]] =
    stamped("getMultirotorState")((state: MultirotorReading) =>
      (
        MultirotorStatus(inWorld(state.kinematics_estimated), flying = state.landed_state == 1),
        state.timestamp
      )
    ).map(_.filterOrElse(
      _.value.kinematics.isFinite,
      RpcError.Malformed("getMultirotorState", "expected finite numbers in kinematics_estimated")
    ))

  /** The truth; AirSim does not say when it was valid. */
  def groundTruth(): Future[Either[RpcError, Kinematics]] =
    get[KinematicsState]("simGetGroundTruthKinematics").map(_.map(inWorld))

  def pose(): Future[Either[RpcError, VehiclePose]] =
    get[Pose]("simGetVehiclePose").map(_.map(pose =>
      VehiclePose(pose.position.toVector + originNed, pose.orientation.toQuaternion)
    ))

  /** Puts the vehicle elsewhere. It keeps its velocity and its goal: one that holds a position flies back there, one that
    * stood on the ground falls.
    */
  def setPose(pose: VehiclePose): Future[Either[RpcError, Unit]] =
    tell("simSetVehiclePose", own(pose), Bool(true))

  /** Lets the vehicle hover at a place above the ground, level and at rest, as if it had long done so; it must be under api
    * control. The built-in simulator alone can do that.
    */
  def hoverAt(pose: VehiclePose): Future[Either[RpcError, Unit]] = tell("skeinHoverAt", own(pose))

  /** What was touched since the last call, if anything was. */
  def collision(): Future[Either[RpcError, Option[Collision]]] =
    call[CollisionInfo]("simGetCollisionInfo", Seq(), once).map(_.map: info =>
      Option.when(info.has_collided)(
        Collision(info.time_stamp, info.position.toVector + originNed, info.normal.toVector, info.object_name)
      ))

  /** The start of the vehicle on the globe. */
  def home(): Future[Either[RpcError, GeoLocation]] = get[GeoPoint]("getHomeGeoPoint").map(_.map(located))

  // ---- sensors; an empty name means the first of its kind

  def imu(sensor: String = ""): Future[Either[RpcError, Stamped[ImuReading]]] =
    measured("getImuData", Str(sensor)): (data: ImuData) =>
      val reading = ImuReading(
        data.orientation.toQuaternion,
        data.angular_velocity.toVector,
        data.linear_acceleration.toVector
      )
      (reading, data.time_stamp)

  def gps(sensor: String = ""): Future[Either[RpcError, Stamped[GpsReading]]] =
    measured("getGpsData", Str(sensor)): (data: GpsData) =>
      val reading = GpsReading(located(data.gnss.geo_point), data.gnss.velocity.toVector, data.is_valid)
      (reading, data.time_stamp)

  def barometer(sensor: String = ""): Future[Either[RpcError, Stamped[BarometerReading]]] =
    measured("getBarometerData", Str(sensor)): (data: BarometerData) =>
      (BarometerReading(Metres(data.altitude), data.pressure), data.time_stamp)

  /** Magnetic field, body FRD, gauss. */
  def magnetometer(sensor: String = ""): Future[Either[RpcError, Stamped[Vector3]]] =
    measured("getMagnetometerData", Str(sensor)): (data: MagnetometerData) =>
      (data.magnetic_field_body.toVector, data.time_stamp)

  /** Rotors in AirSim's order: front right, rear left, front left, rear right. */
  def rotors(): Future[Either[RpcError, Stamped[Seq[RotorReading]]]] =
    stamped("getRotorStates"): (states: RotorStates) =>
      val rotors = states.rotors.map(rotor => RotorReading(rotor.thrust, rotor.torque_scaler, rotor.speed))
      (rotors, states.timestamp)

  // ---- control

  /** Without api control moves answer true and do nothing. */
  def enableApiControl(on: Boolean = true): Future[Either[RpcError, Unit]] =
    tell("enableApiControl", Bool(on))

  def isApiControlEnabled(): Future[Either[RpcError, Boolean]] = get("isApiControlEnabled")

  def arm(): Future[Either[RpcError, Boolean]] = ask("armDisarm", Bool(true))

  def disarm(): Future[Either[RpcError, Boolean]] = ask("armDisarm", Bool(false))

  /** Ends the move under way, with false. It travels behind every command sent before, on their connection. */
  def cancelLastTask(): Future[Either[RpcError, Unit]] =
    call[Msg]("cancelLastTask", Seq(), once.copy(key = Some(connectionKey))).map(_.map(_ => ()))

  /** Answers when every command sent before has reached the simulator: it travels behind them, on their connection. */
  def reached(): Future[Either[RpcError, Unit]] =
    client.rpc.call("ping", Seq(), once.copy(key = Some(connectionKey))).map(_.map(_ => ()))

  // ---- moves

  /** Climbs by 2 m. AirSim stops half a metre short and answers false. */
  def takeoff(timeout: Span = Span.ofSeconds(20)): Future[Either[RpcError, Boolean]] =
    move("takeoff", timeout, seconds(timeout))

  /** Sinks at 0.2 m/s until it stands. */
  def land(timeout: Span = Span.ofSeconds(60)): Future[Either[RpcError, Boolean]] =
    move("land", timeout, seconds(timeout))

  /** Flies to its start. */
  def goHome(timeout: Span = Span.ofSeconds(600)): Future[Either[RpcError, Boolean]] =
    move("goHome", timeout, seconds(timeout))

  /** Ends the move under way; 60 ms later the vehicle holds the place it has then. AirSim answers false. */
  def hover(): Future[Either[RpcError, Boolean]] = move("hover", Span.Zero)

  /** Flies with a velocity.
    *
    * @param velocityNed
    *   m/s
    * @param withdrawn
    *   when it completes, the answer is waited for no longer
    */
  def moveByVelocity(
      velocityNed: Vector3,
      duration: Span,
      yaw: Yaw = Yaw.Still,
      withdrawn: Option[Future[?]] = None
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocity", velocityNed.x, velocityNed.y, velocityNed.z, duration, yaw, withdrawn)

  /** Flies with a horizontal velocity at an altitude: the paper's command.
    *
    * @param velocityNed
    *   m/s; its third component is ignored
    * @param down
    *   altitude goal, world NED
    * @param withdrawn
    *   when it completes, the answer is waited for no longer
    */
  def moveByVelocityZ(
      velocityNed: Vector3,
      down: Metres,
      duration: Span,
      yaw: Yaw = Yaw.Still,
      withdrawn: Option[Future[?]] = None
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocityZ", velocityNed.x, velocityNed.y, ownDown(down), duration, yaw, withdrawn)

  /** Like [[moveByVelocity]], in the frame that has the vehicle's heading at the start of the move. */
  def moveByVelocityBodyFrame(
      velocity: Vector3,
      duration: Span,
      yaw: Yaw = Yaw.Still
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocityBodyFrame", velocity.x, velocity.y, velocity.z, duration, yaw)

  /** Like [[moveByVelocityZ]], in the frame that has the vehicle's heading at the start of the move. */
  def moveByVelocityZBodyFrame(
      velocity: Vector3,
      down: Metres,
      duration: Span,
      yaw: Yaw = Yaw.Still
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocityZBodyFrame", velocity.x, velocity.y, ownDown(down), duration, yaw)

  def moveToPosition(
      positionNed: Vector3,
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    val own = positionNed - originNed
    move(
      "moveToPosition",
      timeout,
      Seq(real(own.x), real(own.y), real(own.z)) ++ along(speed, timeout, yaw, lookahead)*
    )

  def moveOnPath(
      pathNed: Seq[Vector3],
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    val path = writeMsg(pathNed.map(point => Vector3r(point - originNed)))
    move("moveOnPath", timeout, path +: along(speed, timeout, yaw, lookahead)*)

  def moveToZ(
      down: Metres,
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    move(
      "moveToZ",
      timeout,
      Seq(real(ownDown(down)), real(speed.value), seconds(timeout), writeMsg(yaw.mode)) ++ lookahead.params*
    )

  /** Flies to a place on the globe. */
  def moveToGps(
      location: GeoLocation,
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    val place =
      Seq(Float64(location.latitudeDeg), Float64(location.longitudeDeg), real(location.altitude.value))
    move("moveToGPS", timeout, place ++ along(speed, timeout, yaw, lookahead)*)

  /** Turns until the heading is within `margin`. */
  def rotateToYaw(
      heading: Radians,
      timeout: Span = Span.ofSeconds(60),
      margin: Radians = Radians(math.toRadians(5))
  ): Future[Either[RpcError, Boolean]] =
    move("rotateToYaw", timeout, degrees(heading.value), seconds(timeout), degrees(margin.value))

  /** @param radiansPerSecond
    *   clockwise seen from above
    */
  def rotateByYawRate(radiansPerSecond: Double, duration: Span): Future[Either[RpcError, Boolean]] =
    move("rotateByYawRate", duration, degrees(radiansPerSecond), seconds(duration))

  // ---- helpers

  private def byVelocity(
      method: String,
      x: Double,
      y: Double,
      third: Double,
      duration: Span,
      yaw: Yaw,
      withdrawn: Option[Future[?]] = None
  ): Future[Either[RpcError, Boolean]] =
    val params =
      Seq(real(x), real(y), real(third), seconds(duration), Int32(yaw.drivetrain), writeMsg(yaw.mode))
    call(method, params, moving(duration).copy(withdrawn = withdrawn))

  protected def attitude(
      method: String,
      first: Double,
      second: Double,
      third: Double,
      fourth: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    move(method, duration, real(first), real(second), real(third), real(fourth), seconds(duration))

  private def along(speed: MetresPerSecond, timeout: Span, yaw: Yaw, lookahead: Lookahead): Seq[Msg] =
    Seq(real(speed.value), seconds(timeout), Int32(yaw.drivetrain), writeMsg(yaw.mode)) ++ lookahead.params

  private def move(method: String, lasts: Span, params: Msg*): Future[Either[RpcError, Boolean]] =
    call(method, params, moving(lasts))

  private def moving(lasts: Span) = once.copy(timeout = client.timeout + lasts, key = Some(connectionKey))

  private def get[A: Reader](method: String): Future[Either[RpcError, A]] = call(method, Seq(), getter)

  private def ask(method: String, params: Msg*): Future[Either[RpcError, Boolean]] =
    call(method, params, once)

  private def tell(method: String, params: Msg*): Future[Either[RpcError, Unit]] =
    call[Msg](method, params, once).map(_.map(_ => ()))

  private def call[A: Reader](
      method: String,
      params: Seq[Msg],
      options: CallOptions
  ): Future[Either[RpcError, A]] =
    client.rpc.callAs[A](method, params :+ Str(name), options)

  /** A getter whose answer says when it was valid. */
  private def stamped[A: Reader, B](method: String, params: Msg*)(
      read: A => (B, Instant)
  ): Future[Either[RpcError, Stamped[B]]] = asked(getter, method, params)(read)

  private def measured[A: Reader, B](method: String, params: Msg*)(
      read: A => (B, Instant)
  ): Future[Either[RpcError, Stamped[B]]] = asked(sensor, method, params)(read)

  private def asked[A: Reader, B](options: CallOptions, method: String, params: Seq[Msg])(
      read: A => (B, Instant)
  ): Future[Either[RpcError, Stamped[B]]] =
    client.rpc
      .callStampedAs[A](method, params :+ Str(name), options)
      .map(_.map: answer =>
        val (value, validAt) = read(answer.value)
        Stamped(value, validAt, answer.sentAt, answer.receivedAt))

  private def own(pose: VehiclePose): Msg =
    writeMsg(Pose(Vector3r(pose.positionNed - originNed), Quaternionr(pose.orientation)))

  private def inWorld(state: KinematicsState): Kinematics =
    Kinematics(
      state.position.toVector + originNed,
      state.linear_velocity.toVector,
      state.orientation.toQuaternion,
      state.angular_velocity.toVector
    )

  private def located(point: GeoPoint): GeoLocation =
    GeoLocation(point.latitude, point.longitude, Metres(point.altitude))

  protected def ownDown(down: Metres): Double = down.value - originNed.z

  private def real(value: Double): Msg      = Float32(value.toFloat)
  private def seconds(span: Span): Msg      = real(span.toSeconds)
  private def degrees(radians: Double): Msg = real(math.toDegrees(radians))

object Multirotor:

  /** The vehicle of this name; its origin is read from the simulator's settings. */
  def named(client: AirSimClient, name: String): Future[Either[AirSimError, Multirotor]] =
    given ExecutionContext = ExecutionContext.parasitic
    client.vehicles().flatMap:
      case Left(error)                           => Future.successful(Left(AirSimError.Call(error)))
      case Right(names) if !names.contains(name) =>
        Future.successful(Left(AirSimError.UnknownVehicle(name, names)))
      case Right(names) =>
        client.settings().map(_.map: world =>
          val origin = world.vehicles.find(_.name == name).fold(Vector3.Zero)(_.startNed)
          Multirotor(client, name, origin, connectionKey = names.indexOf(name)))
