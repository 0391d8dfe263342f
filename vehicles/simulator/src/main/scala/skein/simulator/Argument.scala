package skein.simulator

import java.nio.charset.StandardCharsets.UTF_8
import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.airsim.wire.*
import skein.units.Instant
import upack.*

/** Reads an argument of this type as AirSim's server does, with the conversions of msgpack-c, which its
  * rpclib uses.
  *
  *   - A float may be sent as an integer, never as a boolean, a string or nil; a float is not accepted as an
  *     integer, nor is an integer out of its type's range.
  *   - A string may be sent as str or as bin, which old clients send.
  *   - A map's missing keys keep their defaults and unknown keys are skipped, at any depth; a map with a key
  *     that is not a string, or another kind of value in its place, is refused.
  *   - A refusal is reported as `std::bad_cast`, without its position.
  *
  * Unlike AirSim's server, this refuses numbers that are not finite, or too large for a 32-bit float
  * argument, or vectors and positions beyond a limit: they would corrupt physics for good.
  */
private[simulator] trait Argument[A]:
  def read(value: Msg): A

/** An argument that is refused; its message is the text of the answer. */
private[simulator] sealed class BadArgument(text: String)
    extends RuntimeException(text, null, /* enableSuppression = */ false, /* writableStackTrace = */ false)

/** A number that is not finite, or becomes infinite as a 32-bit float. */
final private[simulator] class NotFinite extends BadArgument("parameters must be finite numbers")

private[simulator] object Argument:
  /** An integer from 0 to 2³² − 1. */
  opaque type Unsigned32 <: Long = Long

  given Argument[Boolean] =
    case Bool(value) => value
    case _           => badCast

  given Argument[Int] = integer(_, Int.MinValue, Int.MaxValue).toInt

  given Argument[Unsigned32] = integer(_, 0, 0xffffffffL)

  /** Reads a time stamp in nanoseconds: unsigned, up to the greatest signed 64-bit number. */
  given Argument[Instant] = value => Instant.ofNanos(integer(value, 0, Long.MaxValue))

  given Argument[Double] = value => finite(number(value))

  given Argument[Float] = value => finite(number(value).toFloat).toFloat

  given Argument[String] =
    case Str(text)   => text
    case Binary(raw) => String(raw, UTF_8)
    case _           => badCast

  given [A](using element: Argument[A]): Argument[Seq[A]] =
    case Arr(values) => values.iterator.map(element.read).toVector
    case _           => badCast

  /** Greatest magnitude of a vector's components, in m, m/s or rad: there a 32-bit float has steps of 64. */
  private val Greatest = 1e9f

  given Argument[Vector3r] = checked(record(Vector3r.Zero)): vector =>
    if Seq(vector.x_val, vector.y_val, vector.z_val).forall(math.abs(_) <= Greatest) then None
    else Some("the numbers of a vector are within 1e9")

  given Argument[Quaternionr] = record(Quaternionr(1, 0, 0, 0))
  given Argument[Pose]        = record(Pose(Vector3r.Zero, Quaternionr(1, 0, 0, 0)))

  /** Reads None from a value of the right type whose numbers are not finite. */
  given [A](using argument: Argument[A]): Argument[Option[A]] = value =>
    try Some(argument.read(value))
    catch case _: NotFinite => None

  given Argument[YawMode]     = record(YawMode.Still)
  given Argument[RcData]      = record(RcData.Absent)
  given Argument[CarControls] = record(CarControls())
  given Argument[GeoPoint]    = checked(record(GeoPoint(0, 0, 0))): point =>
    misplaced(point.latitude, point.longitude, point.altitude)

  /** The reason why this is not a geographic position; None if it is one. */
  def misplaced(latitudeDeg: Double, longitudeDeg: Double, altitudeM: Float): Option[String] =
    Option.unless(
      math.abs(latitudeDeg) <= 90 && math.abs(longitudeDeg) <= 360 && math.abs(altitudeM) <= 1e6f
    ):
      "a place has latitudes within 90 degrees, longitudes within 360 and altitudes within 1000 km"

  private def checked[A](argument: Argument[A])(mistake: A => Option[String]): Argument[A] = value =>
    val read = argument.read(value)
    mistake(read).fold(read)(why => throw BadArgument(why))

  given Argument[KinematicsState] = record(
    KinematicsState(
      Vector3r.Zero,
      Quaternionr(1, 0, 0, 0),
      Vector3r.Zero,
      Vector3r.Zero,
      Vector3r.Zero,
      Vector3r.Zero
    )
  )

  given Argument[ImageRequest] = record(ImageRequest("", 0, pixels_as_float = false, compress = true))

  /** Reads a map whose keys are the fields' names; `default` supplies missing fields. */
  inline def record[A <: Product](default: A)(using mirror: Mirror.ProductOf[A]): Argument[A] =
    val names = constValueTuple[mirror.MirroredElemLabels].toList.asInstanceOf[List[String]]
    Record(default, names.map(Str(_)).zip(each[mirror.MirroredElemTypes]), mirror.fromProduct)

  inline def each[T <: Tuple]: List[Argument[?]] =
    summonAll[Tuple.Map[T, Argument]].toList.asInstanceOf[List[Argument[?]]]

  final private class Record[A <: Product](
      default: A,
      fields: List[(Msg, Argument[?])],
      make: Product => A
  ) extends Argument[A]:
    def read(value: Msg): A = value match
      case Obj(entries) =>
        if !entries.keysIterator.forall(_.isInstanceOf[Str | Binary]) then badCast
        val values = fields.zip(default.productIterator).map:
          case ((name, reader), unless) => entries.get(name).fold(unless)(reader.read)
        make(Tuple.fromArray(values.toArray))
      case _ => badCast

  private def badCast: Nothing = throw BadArgument("std::bad_cast")

  private def integer(value: Msg, least: Long, greatest: Long): Long =
    val number = value match
      case Int32(number)                 => number.toLong
      case Int64(number)                 => number
      case UInt64(number) if number >= 0 => number
      case _                             => badCast
    if number >= least && number <= greatest then number else badCast

  private def number(value: Msg): Double = value match
    case Float32(number) => number.toDouble
    case Float64(number) => number
    case Int32(number)   => number.toDouble
    case Int64(number)   => number.toDouble
    case UInt64(number)  => unsigned(number)
    case _               => badCast

  private def finite(number: Double): Double =
    if number.isFinite then number else throw NotFinite()

  private def unsigned(number: Long): Double =
    if number >= 0 then number.toDouble else (number >>> 1).toDouble * 2
