package skein.mavlink

/** Constants of MAVLink's common dialect (mavlink.io, `common.xml`). */
object CommonDialect:
  val Autopilot1 = 1

  /** A heartbeat's autopilot field when the sender is not an autopilot. */
  val NoAutopilot = 8

  object Command:
    val Waypoint            = 16
    val LoiterUnlimited     = 17
    val LoiterTime          = 19
    val ReturnToLaunch      = 20
    val Land                = 21
    val Takeoff             = 22
    val Delay               = 93
    val SetMode             = 176
    val ChangeSpeed         = 178
    val Terminate           = 185
    val Reposition          = 192
    val StartMission        = 300
    val Arm                 = 400
    val GetHome             = 410
    val SetMessageInterval  = 511
    val RequestMessage      = 512
    val RequestCapabilities = 520

  object Result:
    val Accepted    = 0
    val Rejected    = 1
    val Denied      = 2
    val Unsupported = 3
    val Failed      = 4
    val InProgress  = 5

  object Frame:
    val Global            = 0
    val LocalNed          = 1
    val Mission           = 2
    val RelativeAltitude  = 3
    val GlobalInt         = 5
    val RelativeAltitudeI = 6
    val BodyNed           = 8
    val BodyFrd           = 12

  /** Severities of status texts, as in syslog. */
  object Severity:
    val Critical = 2
    val Warning  = 4
    val Info     = 6

  /** The parameter that makes arming or disarming ignore all checks. */
  val Force = 21196

  /** Bits of the base mode in a heartbeat. */
  object ModeFlag:
    val Custom     = 1
    val Automatic  = 4
    val Guided     = 8
    val Stabilized = 16
    val Armed      = 128

  /** Bits of a setpoint's type mask: fields to ignore. */
  object Ignore:
    val X        = 1
    val Y        = 2
    val Z        = 4
    val Vx       = 8
    val Vy       = 16
    val Vz       = 32
    val Force    = 512
    val Yaw      = 1024
    val YawRate  = 2048
    val Position = X | Y | Z
    val Velocity = Vx | Vy | Vz

    val Acceleration = 64 | 128 | 256
