package skein.mavlink

/** A message of the common dialect. Fields have the published order and names; units are those of the
  * definitions (mavlink.io, `common.xml`), which vary from message to message. Unsigned numbers of up to 32
  * bits are not negative here; unsigned numbers of 64 bits keep their bits, so the largest ones are negative.
  * Fields with a default are extensions, which older peers do not know.
  */
sealed trait Message extends Product

/** Kind, mode and state of the sender, once a second. */
final case class Heartbeat(
    `type`: Int,
    autopilot: Int,
    baseMode: Int,
    customMode: Long,
    systemStatus: Int,
    mavlinkVersion: Int
) extends Message

/** Health of sensors, and the battery: volts in mV, current in cA, remaining charge in %. */
final case class SysStatus(
    onboardControlSensorsPresent: Long,
    onboardControlSensorsEnabled: Long,
    onboardControlSensorsHealth: Long,
    load: Int,
    voltageBattery: Int,
    currentBattery: Int,
    batteryRemaining: Int,
    dropRateComm: Int,
    errorsComm: Int,
    errorsCount1: Int,
    errorsCount2: Int,
    errorsCount3: Int,
    errorsCount4: Int,
    onboardControlSensorsPresentExtended: Long = 0,
    onboardControlSensorsEnabledExtended: Long = 0,
    onboardControlSensorsHealthExtended: Long = 0
) extends Message

/** The sender's clock: µs since 1970, and ms since its start. */
final case class SystemTime(timeUnixUsec: Long, timeBootMs: Long) extends Message

/** Requests a parameter: by its name if the index is −1. */
final case class ParamRequestRead(targetSystem: Int, targetComponent: Int, paramId: String, paramIndex: Int)
    extends Message

/** Requests all parameters, one `ParamValue` each. */
final case class ParamRequestList(targetSystem: Int, targetComponent: Int) extends Message

/** A parameter. The value of an integer is sent by its bits (PX4) or as a number (ArduPilot). */
final case class ParamValue(
    paramId: String,
    paramValue: Float,
    paramType: Int,
    paramCount: Int,
    paramIndex: Int
) extends Message

/** Sets a parameter; the answer is a `ParamValue`. */
final case class ParamSet(
    targetSystem: Int,
    targetComponent: Int,
    paramId: String,
    paramValue: Float,
    paramType: Int
) extends Message

/** A GPS fix: degrees × 10⁷, altitudes in mm, velocities in cm/s, angles in cdeg. */
final case class GpsRawInt(
    timeUsec: Long,
    fixType: Int,
    lat: Int,
    lon: Int,
    alt: Int,
    eph: Int,
    epv: Int,
    vel: Int,
    cog: Int,
    satellitesVisible: Int,
    altEllipsoid: Int = 0,
    hAcc: Long = 0,
    vAcc: Long = 0,
    velAcc: Long = 0,
    hdgAcc: Long = 0,
    yaw: Int = 0
) extends Message

/** Attitude: roll, pitch and yaw in rad, rates in rad/s. */
final case class Attitude(
    timeBootMs: Long,
    roll: Float,
    pitch: Float,
    yaw: Float,
    rollspeed: Float,
    pitchspeed: Float,
    yawspeed: Float
) extends Message

/** Rotation from body FRD to NED: w, x, y, z; rates in rad/s. */
final case class AttitudeQuaternion(
    timeBootMs: Long,
    q1: Float,
    q2: Float,
    q3: Float,
    q4: Float,
    rollspeed: Float,
    pitchspeed: Float,
    yawspeed: Float,
    reprOffsetQ: Vector[Float] = Vector.empty
) extends Message

/** Position in m and velocity in m/s, NED, from the vehicle's own origin. */
final case class LocalPositionNed(
    timeBootMs: Long,
    x: Float,
    y: Float,
    z: Float,
    vx: Float,
    vy: Float,
    vz: Float
) extends Message

/** Degrees × 10⁷, altitudes in mm above the sea and above home, velocities in cm/s, heading in cdeg. */
final case class GlobalPositionInt(
    timeBootMs: Long,
    lat: Int,
    lon: Int,
    alt: Int,
    relativeAlt: Int,
    vx: Int,
    vy: Int,
    vz: Int,
    hdg: Int
) extends Message

/** Continues the mission at the item with this number. */
final case class MissionSetCurrent(targetSystem: Int, targetComponent: Int, seq: Int) extends Message

/** The mission item that the vehicle is flying to. */
final case class MissionCurrent(seq: Int, total: Int = 0, missionState: Int = 0, missionMode: Int = 0)
    extends Message

/** Requests the number of mission items (`MissionCount`). */
final case class MissionRequestList(targetSystem: Int, targetComponent: Int, missionType: Int = 0)
    extends Message

/** Announces `count` mission items, to be requested one by one. */
final case class MissionCount(targetSystem: Int, targetComponent: Int, count: Int, missionType: Int = 0)
    extends Message

/** Deletes the mission that is on the vehicle. */
final case class MissionClearAll(targetSystem: Int, targetComponent: Int, missionType: Int = 0)
    extends Message

/** Reports that the vehicle has reached a mission item. */
final case class MissionItemReached(seq: Int) extends Message

/** The result of a mission transfer; 0 is success. */
final case class MissionAck(targetSystem: Int, targetComponent: Int, `type`: Int, missionType: Int = 0)
    extends Message

/** The geographic origin of the vehicle's local frame: degrees × 10⁷, mm above the sea. */
final case class GpsGlobalOrigin(latitude: Int, longitude: Int, altitude: Int, timeUsec: Long = 0)
    extends Message

/** Requests one mission item, with integer coordinates. */
final case class MissionRequestInt(targetSystem: Int, targetComponent: Int, seq: Int, missionType: Int = 0)
    extends Message

/** A mission item: a command and a position, degrees × 10⁷ or m × 10⁴. */
final case class MissionItemInt(
    targetSystem: Int,
    targetComponent: Int,
    seq: Int,
    frame: Int,
    command: Int,
    current: Int,
    autocontinue: Int,
    param1: Float,
    param2: Float,
    param3: Float,
    param4: Float,
    x: Int,
    y: Int,
    z: Float,
    missionType: Int = 0
) extends Message

/** A command with a position, in integer coordinates. */
final case class CommandInt(
    targetSystem: Int,
    targetComponent: Int,
    frame: Int,
    command: Int,
    current: Int,
    autocontinue: Int,
    param1: Float,
    param2: Float,
    param3: Float,
    param4: Float,
    x: Int,
    y: Int,
    z: Float
) extends Message

/** A command with seven parameters; answered by [[CommandAck]]. */
final case class CommandLong(
    targetSystem: Int,
    targetComponent: Int,
    command: Int,
    confirmation: Int,
    param1: Float,
    param2: Float,
    param3: Float,
    param4: Float,
    param5: Float,
    param6: Float,
    param7: Float
) extends Message

/** The result of a command, or its progress. */
final case class CommandAck(
    command: Int,
    result: Int,
    progress: Int = 0,
    resultParam2: Int = 0,
    targetSystem: Int = 0,
    targetComponent: Int = 0
) extends Message

/** Attitude (w, x, y, z), body rates and thrust to hold; mask bits name fields to ignore. */
final case class SetAttitudeTarget(
    timeBootMs: Long,
    targetSystem: Int,
    targetComponent: Int,
    typeMask: Int,
    q: Vector[Float],
    bodyRollRate: Float,
    bodyPitchRate: Float,
    bodyYawRate: Float,
    thrust: Float
) extends Message

/** Position, velocity, acceleration and yaw to hold, SI; mask bits name fields to ignore. */
final case class SetPositionTargetLocalNed(
    timeBootMs: Long,
    targetSystem: Int,
    targetComponent: Int,
    coordinateFrame: Int,
    typeMask: Int,
    x: Float,
    y: Float,
    z: Float,
    vx: Float,
    vy: Float,
    vz: Float,
    afx: Float,
    afy: Float,
    afz: Float,
    yaw: Float,
    yawRate: Float
) extends Message

/** The setpoint that the vehicle follows, in the local frame. */
final case class PositionTargetLocalNed(
    timeBootMs: Long,
    coordinateFrame: Int,
    typeMask: Int,
    x: Float,
    y: Float,
    z: Float,
    vx: Float,
    vy: Float,
    vz: Float,
    afx: Float,
    afy: Float,
    afz: Float,
    yaw: Float,
    yawRate: Float
) extends Message

/** A setpoint with a global position (latitude, longitude). */
final case class SetPositionTargetGlobalInt(
    timeBootMs: Long,
    targetSystem: Int,
    targetComponent: Int,
    coordinateFrame: Int,
    typeMask: Int,
    latInt: Int,
    lonInt: Int,
    alt: Float,
    vx: Float,
    vy: Float,
    vz: Float,
    afx: Float,
    afy: Float,
    afz: Float,
    yaw: Float,
    yawRate: Float
) extends Message

/** A request with `tc1` 0 and the requester's time in `ts1`; the answer repeats `ts1` and has the answerer's
  * time in `tc1`, ns.
  */
final case class Timesync(tc1: Long, ts1: Long, targetSystem: Int = 0, targetComponent: Int = 0)
    extends Message

/** Battery: cells in mV, current in cA, temperature in cdeg C. */
final case class BatteryStatus(
    id: Int,
    batteryFunction: Int,
    `type`: Int,
    temperature: Int,
    voltages: Vector[Int],
    currentBattery: Int,
    currentConsumed: Int,
    energyConsumed: Int,
    batteryRemaining: Int,
    timeRemaining: Int = 0,
    chargeState: Int = 0,
    voltagesExt: Vector[Int] = Vector.empty,
    mode: Int = 0,
    faultBitmask: Long = 0
) extends Message

/** Capabilities and version numbers of an autopilot. */
final case class AutopilotVersion(
    capabilities: Long,
    flightSwVersion: Long,
    middlewareSwVersion: Long,
    osSwVersion: Long,
    boardVersion: Long,
    flightCustomVersion: Vector[Int],
    middlewareCustomVersion: Vector[Int],
    osCustomVersion: Vector[Int],
    vendorId: Int,
    productId: Int,
    uid: Long,
    uid2: Vector[Int] = Vector.empty
) extends Message

/** The position to which the vehicle returns. */
final case class HomePosition(
    latitude: Int,
    longitude: Int,
    altitude: Int,
    x: Float,
    y: Float,
    z: Float,
    q: Vector[Float],
    approachX: Float,
    approachY: Float,
    approachZ: Float,
    timeUsec: Long = 0
) extends Message

/** The interval at which a message is sent; −1 is never, 0 the default. */
final case class MessageInterval(messageId: Int, intervalUs: Int) extends Message

/** Landed state: on the ground (1), in the air (2), taking off (3) or landing (4). */
final case class ExtendedSysState(vtolState: Int, landedState: Int) extends Message

/** A line of text for a person; a long one in several pieces with one `id`. */
final case class Statustext(severity: Int, text: String, id: Int = 0, chunkSeq: Int = 0) extends Message

/** Motor and servo controls of a simulated vehicle, from its autopilot: 0 to 1 each, or −1 to 1; the mode is
  * a heartbeat's, and the first flag states lockstep.
  */
final case class HilActuatorControls(timeUsec: Long, controls: Vector[Float], mode: Int, flags: Long)
    extends Message

/** Sensor readings of a simulated vehicle: m/s², rad/s, gauss, hPa, m, °C; `fieldsUpdated` has a bit for each
  * new field.
  */
final case class HilSensor(
    timeUsec: Long,
    xacc: Float,
    yacc: Float,
    zacc: Float,
    xgyro: Float,
    ygyro: Float,
    zgyro: Float,
    xmag: Float,
    ymag: Float,
    zmag: Float,
    absPressure: Float,
    diffPressure: Float,
    pressureAlt: Float,
    temperature: Float,
    fieldsUpdated: Long,
    id: Int = 0
) extends Message

/** A simulated vehicle's satellite fix: degE7, mm, cm, cm/s, cdeg. */
final case class HilGps(
    timeUsec: Long,
    fixType: Int,
    lat: Int,
    lon: Int,
    alt: Int,
    eph: Int,
    epv: Int,
    vel: Int,
    vn: Int,
    ve: Int,
    vd: Int,
    cog: Int,
    satellitesVisible: Int,
    id: Int = 0,
    yaw: Int = 0
) extends Message

/** The true state of a simulated vehicle: degE7, mm, cm/s, and acceleration in thousandths of gravity. */
final case class HilStateQuaternion(
    timeUsec: Long,
    attitudeQuaternion: Vector[Float],
    rollspeed: Float,
    pitchspeed: Float,
    yawspeed: Float,
    lat: Int,
    lon: Int,
    alt: Int,
    vx: Int,
    vy: Int,
    vz: Int,
    indAirspeed: Int,
    trueAirspeed: Int,
    xacc: Int,
    yacc: Int,
    zacc: Int
) extends Message

/** Position, attitude and velocity, each in the stated frame; rates in rad/s. */
final case class Odometry(
    timeUsec: Long,
    frameId: Int,
    childFrameId: Int,
    x: Float,
    y: Float,
    z: Float,
    q: Vector[Float],
    vx: Float,
    vy: Float,
    vz: Float,
    rollspeed: Float,
    pitchspeed: Float,
    yawspeed: Float,
    poseCovariance: Vector[Float],
    velocityCovariance: Vector[Float],
    resetCounter: Int = 0,
    estimatorType: Int = 0,
    quality: Int = 0
) extends Message
