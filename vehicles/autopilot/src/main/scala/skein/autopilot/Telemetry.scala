package skein.autopilot

import skein.mavlink.*
import skein.units.*

/** The messages that an autopilot sends of itself and its vehicle, by message number. */
object Telemetry:
  private val boundedInt = (number: Double) => number.max(Int.MinValue).min(Int.MaxValue).round.toInt

  /** Intervals of the messages that are sent without a request, similar to PX4's; ms. */
  val intervals: Map[Int, Span] = Map(
    0   -> 1000, // HEARTBEAT
    1   -> 1000, // SYS_STATUS
    2   -> 1000, // SYSTEM_TIME
    24  -> 200,  // GPS_RAW_INT
    30  -> 50,   // ATTITUDE
    31  -> 50,   // ATTITUDE_QUATERNION
    32  -> 50,   // LOCAL_POSITION_NED
    33  -> 100,  // GLOBAL_POSITION_INT
    42  -> 1000, // MISSION_CURRENT
    49  -> 1000, // GPS_GLOBAL_ORIGIN
    147 -> 1000, // BATTERY_STATUS
    242 -> 1000, // HOME_POSITION
    245 -> 200,  // EXTENDED_SYS_STATE
    331 -> 50    // ODOMETRY
  ).view.mapValues(millis => Span.ofMillis(millis)).toMap

  /** The messages about the vehicle's motion: GPS_RAW_INT, ATTITUDE, ATTITUDE_QUATERNION, LOCAL_POSITION_NED,
    * GLOBAL_POSITION_INT, ODOMETRY.
    */
  val ofMotion: Set[Int] = Set(24, 30, 31, 32, 33, 331)

  /** The shortest interval at which any message is sent. */
  val Shortest: Span = Span.ofMillis(5)

  /** Encodes a message; None if the number is not one of these messages. */
  def of(id: Int, autopilot: Status, motion: VehicleMotion): Option[Message] =
    val state  = motion.state
    val bootMs = motion.sinceBoot.toNanos / 1_000_000
    val bootUs = motion.sinceBoot.toNanos / 1000
    val place  = state.positionNed
    val speed  = state.velocityNed
    val turn   = state.orientation
    val rates  = state.angularVelocityFrd
    id match
      case 0 => Some(heartbeat(autopilot))
      case 1 =>
        // Gyro, accelerometer, magnetometer, barometer, GPS, the controllers of rates, attitude, yaw,
        // altitude, position, motors, the estimate (AHRS), the battery and the checks before arming.
        val sensors = 0x0220fc2fL | 0x10000000L
        Some(SysStatus(sensors, sensors, sensors, 100, BatteryMv, -1, BatteryPercent, 0, 0, 0, 0, 0, 0))
      case 2  => Some(SystemTime(0, bootMs))
      case 24 =>
        val at     = autopilot.home.locate(place)
        val ground = StrictMath.hypot(speed.x, speed.y)
        Some(GpsRawInt(
          bootUs,
          fixType = 3,
          lat = degrees(at.latitudeDeg),
          lon = degrees(at.longitudeDeg),
          alt = boundedInt(at.altitude.value * 1000),
          eph = 10,
          epv = 10,
          vel = (ground * 100).round.toInt.min(0xfffe),
          cog = centidegrees(StrictMath.atan2(speed.y, speed.x)),
          satellitesVisible = 12
        ))
      case 30 =>
        Some(Attitude(
          bootMs,
          turn.rollRad.toFloat,
          turn.pitchRad.toFloat,
          turn.yawRad.toFloat,
          rates.x.toFloat,
          rates.y.toFloat,
          rates.z.toFloat
        ))
      case 31 =>
        Some(AttitudeQuaternion(
          bootMs,
          turn.w.toFloat,
          turn.x.toFloat,
          turn.y.toFloat,
          turn.z.toFloat,
          rates.x.toFloat,
          rates.y.toFloat,
          rates.z.toFloat
        ))
      case 32 =>
        Some(LocalPositionNed(
          bootMs,
          place.x.toFloat,
          place.y.toFloat,
          place.z.toFloat,
          speed.x.toFloat,
          speed.y.toFloat,
          speed.z.toFloat
        ))
      case 33 =>
        val at                     = autopilot.home.locate(place)
        def centimetres(v: Double) = (v * 100).round.max(-32767).min(32767).toInt
        Some(GlobalPositionInt(
          bootMs,
          degrees(at.latitudeDeg),
          degrees(at.longitudeDeg),
          boundedInt(at.altitude.value * 1000),
          boundedInt(-place.z * 1000),
          centimetres(speed.x),
          centimetres(speed.y),
          centimetres(speed.z),
          centidegrees(turn.yawRad)
        ))
      case 42 => Some(autopilot.mission.told)
      case 49 =>
        val home = autopilot.home
        Some(GpsGlobalOrigin(
          degrees(home.latitudeDeg),
          degrees(home.longitudeDeg),
          boundedInt(home.altitude.value * 1000),
          bootUs
        ))
      case 147 =>
        val cells = Vector(BatteryMv) ++ Vector.fill(9)(0xffff)
        Some(BatteryStatus(0, 0, 1, 32767, cells, -1, -1, -1, BatteryPercent))
      case 148 => Some(version(autopilot))
      case 242 => Some(home(autopilot))
      case 245 =>
        val landed =
          if !motion.isFlying then 1
          else
            autopilot.mode match
              case FlightMode.Takeoff => 3
              case FlightMode.Land    => 4
              case _                  => 2
        Some(ExtendedSysState(0, landed))
      case 331 =>
        val body = turn.toBody(speed)
        Some(Odometry(
          bootUs,
          frameId = CommonDialect.Frame.LocalNed,
          childFrameId = CommonDialect.Frame.BodyFrd,
          place.x.toFloat,
          place.y.toFloat,
          place.z.toFloat,
          Vector(turn.w, turn.x, turn.y, turn.z).map(_.toFloat),
          body.x.toFloat,
          body.y.toFloat,
          body.z.toFloat,
          rates.x.toFloat,
          rates.y.toFloat,
          rates.z.toFloat,
          unknown,
          unknown,
          estimatorType = Estimator,
          quality = 100
        ))
      case _ => None

  def heartbeat(autopilot: Status): Message =
    import CommonDialect.ModeFlag.*
    val guided = if autopilot.mode == FlightMode.Offboard then Guided else Automatic
    val armed  = if autopilot.isArmed then Armed else 0
    Heartbeat(
      `type` = Quadrotor,
      autopilot = Px4,
      baseMode = Custom | Stabilized | guided | armed,
      customMode = autopilot.mode.customMode,
      systemStatus = if autopilot.isArmed then 4 else 3,
      mavlinkVersion = 3
    )

  def home(autopilot: Status): Message =
    val at = autopilot.home
    HomePosition(
      degrees(at.latitudeDeg),
      degrees(at.longitudeDeg),
      boundedInt(at.altitude.value * 1000),
      0,
      0,
      0,
      Vector(1, 0, 0, 0),
      0,
      0,
      0
    )

  /** Version of the PX4 release whose interface this follows; the unique id is the system number. */
  def version(autopilot: Status): Message =
    // Float and integer missions, commands as integers, setpoints of attitude and in the local frame and of
    // the globe, termination, MAVLink 2.
    val can = 1L | 4 | 8 | 64 | 128 | 256 | 2048 | 8192
    AutopilotVersion(
      can,
      0x010f0000L,
      0,
      0,
      0,
      Vector.fill(8)(0),
      Vector.fill(8)(0),
      Vector.fill(8)(0),
      0,
      0,
      autopilot.system.toLong
    )

  private val Quadrotor      = 2
  private val Px4            = 12
  private val Estimator      = 8
  private val BatteryMv      = 16_200
  private val BatteryPercent = 100

  /** An unknown covariance: MAVLink marks it by NaN in the first element. */
  private val unknown = Float.NaN +: Vector.fill(20)(0f)

  private def degrees(value: Double): Int = boundedInt(value * 1e7)

  private def centidegrees(rad: Double): Int =
    val degrees = math.toDegrees(rad)
    ((if degrees < 0 then degrees + 360 else degrees) * 100).toInt % 36000
