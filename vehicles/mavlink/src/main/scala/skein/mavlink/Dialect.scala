package skein.mavlink

import skein.mavlink.Definition.define
import skein.mavlink.Field.*

/** The supported messages, all of the common dialect. */
object Dialect:

  val all: Vector[Definition[? <: Message]] = Vector(
    define[Heartbeat](0)(u8, u8, u8, u32, u8, u8),
    define[SysStatus](1)(
      u32.times(3) ++ ((u16, u16, i16, i8) ++ (u16.times(6) ++ u32.extension.times(3)))
    ),
    define[SystemTime](2)(u64, u32),
    define[ParamRequestRead](20)(u8, u8, chars(16), i16),
    define[ParamRequestList](21)(u8, u8),
    define[ParamValue](22)(chars(16), f32, u8, u16, u16),
    define[ParamSet](23)(u8, u8, chars(16), f32, u8),
    define[GpsRawInt](24)(
      (u64, u8, i32, i32, i32) ++
        (u16.times(4) ++ ((u8, i32.extension) ++ (u32.extension.times(4) ++ Tuple1(u16.extension))))
    ),
    define[Attitude](30)(u32 *: f32.times(6)),
    define[AttitudeQuaternion](31)(u32 *: f32.times(7) ++ Tuple1(f32s(4).extension)),
    define[LocalPositionNed](32)(u32 *: f32.times(6)),
    define[GlobalPositionInt](33)(u32, i32, i32, i32, i32, i16, i16, i16, u16),
    define[MissionSetCurrent](41)(u8, u8, u16),
    define[MissionCurrent](42)(u16, u16.extension, u8.extension, u8.extension),
    define[MissionRequestList](43)(u8, u8, u8.extension),
    define[MissionCount](44)(u8, u8, u16, u8.extension),
    define[MissionClearAll](45)(u8, u8, u8.extension),
    define[MissionItemReached](46)(Tuple1(u16)),
    define[MissionAck](47)(u8, u8, u8, u8.extension),
    define[GpsGlobalOrigin](49)(i32, i32, i32, u64.extension),
    define[MissionRequestInt](51)(u8, u8, u16, u8.extension),
    define[MissionItemInt](73)(u8, u8, u16, u8, u16, u8, u8, f32, f32, f32, f32, i32, i32, f32, u8.extension),
    define[CommandInt](75)(u8, u8, u8, u16, u8, u8, f32, f32, f32, f32, i32, i32, f32),
    define[CommandLong](76)((u8, u8, u16, u8) ++ f32.times(7)),
    define[CommandAck](77)(u16, u8, u8.extension, i32.extension, u8.extension, u8.extension),
    define[SetAttitudeTarget](82)(u32, u8, u8, u8, f32s(4), f32, f32, f32, f32),
    define[SetPositionTargetLocalNed](84)((u32, u8, u8, u8, u16) ++ f32.times(11)),
    define[PositionTargetLocalNed](85)((u32, u8, u16) ++ f32.times(11)),
    define[SetPositionTargetGlobalInt](86)((u32, u8, u8, u8, u16, i32, i32) ++ f32.times(9)),
    define[HilActuatorControls](93)(u64, f32s(16), u8, u64),
    define[HilSensor](107)(u64 *: f32.times(13) ++ (u32, u8.extension)),
    define[Timesync](111)(i64, i64, u8.extension, u8.extension),
    define[HilGps](113)(
      (u64, u8, i32, i32, i32, u16, u16, u16) ++ (i16.times(3) ++ (u16, u8, u8.extension, u16.extension))
    ),
    define[HilStateQuaternion](115)(
      (u64, f32s(4), f32, f32, f32, i32, i32, i32) ++ (i16.times(3) ++ (u16, u16, i16, i16, i16))
    ),
    define[BatteryStatus](147)(
      (u8, u8, u8, i16, u16s(10), i16, i32, i32, i8) ++
        (i32.extension, u8.extension, u16s(4).extension, u8.extension, u32.extension)
    ),
    define[AutopilotVersion](148)(
      u64 *: u32.times(4) ++ (u8s(8).times(3) ++ (u16, u16, u64, u8s(18).extension))
    ),
    define[HomePosition](242)(i32, i32, i32, f32, f32, f32, f32s(4), f32, f32, f32, u64.extension),
    define[MessageInterval](244)(u16, i32),
    define[ExtendedSysState](245)(u8, u8),
    define[Statustext](253)(u8, chars(50), u16.extension, u8.extension),
    define[Odometry](331)(
      (u64, u8, u8, f32, f32, f32, f32s(4)) ++
        (f32.times(6) ++ (f32s(21), f32s(21), u8.extension, u8.extension, i8.extension))
    )
  )

  private val byId: Map[Int, Definition[? <: Message]] =
    all.map(definition => definition.id -> definition).toMap
  private val byClass: Map[Class[?], Definition[? <: Message]] =
    all.map(definition => definition.of -> definition).toMap

  /** The definition of a message number; None if it is unknown, and its checksum cannot be verified. */
  def of(id: Int): Option[Definition[? <: Message]] = byId.get(id)

  def of[A <: Message](message: A): Definition[A] = byClass(message.getClass).asInstanceOf[Definition[A]]
