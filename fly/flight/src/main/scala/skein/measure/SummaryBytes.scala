package skein.measure

import java.io.{ByteArrayInputStream, ByteArrayOutputStream, DataInputStream, DataOutputStream, IOException}
import java.util.zip.{DeflaterOutputStream, InflaterInputStream}
import scala.collection.immutable.ArraySeq
import scala.util.Using
import skein.bytes.Codec
import skein.record.{EventKind, FlightRow, Simulator}
import skein.scenario.{Scenario, Track}
import skein.units.*

/** Encodes a flight's summary, every number to the bit. Derived values (distance, result) are computed anew,
  * and the scenario is the reader's own.
  *
  * Encoded by [[Codec]], except that numbers of one kind are transposed: all first bytes first, since these
  * repeat. Then deflated.
  */
object SummaryBytes:
  /** Maximum inflated size, bytes. */
  private val MostBytes = 256 << 20

  def write(summary: FlightSummary): ArraySeq[Byte] =
    val bytes = ByteArrayOutputStream()
    Using.resource(DataOutputStream(DeflaterOutputStream(bytes)))(Codecs(summary.scenario).all.write(
      summary,
      _
    ))
    ArraySeq.unsafeWrapArray(bytes.toByteArray)

  /** Decodes a summary.
    *
    * @param scenario the flight's scenario; absent if it is not known
    * @return Left says why these bytes are not a summary
    */
  def read(bytes: ArraySeq[Byte], scenario: Option[Scenario]): Either[String, FlightSummary] =
    try Right(Codecs(scenario).all.read(DataInputStream(ByteArrayInputStream(inflated(bytes.toArray)))))
    catch
      case wrong @ (_: IOException | _: IllegalArgumentException | _: NoSuchElementException) =>
        Left(s"expected a flight's summary, got ${bytes.length} bytes that are none: $wrong")

  private def inflated(bytes: Array[Byte]): Array[Byte] =
    val all = InflaterInputStream(ByteArrayInputStream(bytes)).readNBytes(MostBytes + 1)
    if all.length > MostBytes then throw IOException(s"they come to more than $MostBytes")
    all

  private final class Codecs(scenario: Option[Scenario]):
    private val eyes = scenario.toVector.flatMap(_.eyes)

    private given longs: Codec[Vector[Long]] = new Codec[Vector[Long]]:
      def write(value: Vector[Long], out: DataOutputStream): Unit =
        out.writeInt(value.size)
        for place <- 7 to 0 by -1; number <- value do out.writeByte((number >> (8 * place)).toInt)
      def read(in: DataInputStream): Vector[Long] =
        val values = new Array[Long](Codec.length(in))
        for _ <- 0 until 8; index <- values.indices do
          values(index) = values(index) << 8 | in.readUnsignedByte().toLong
        values.toVector

    private given doubles: Codec[Vector[Double]] =
      longs.imap(_.map(java.lang.Double.longBitsToDouble))(_.map(java.lang.Double.doubleToRawLongBits))
    private given vectors: Codec[Vector[Vector3]] = Codec
      .derived[(Vector[Double], Vector[Double], Vector[Double])]
      .imap((x, y, z) => x.lazyZip(y).lazyZip(z).map(Vector3(_, _, _)).toVector)(of =>
        (of.map(_.x), of.map(_.y), of.map(_.z))
      )
    private given pairs: Codec[Vector[(Double, Double)]] =
      Codec.derived[(Vector[Double], Vector[Double])].imap((first, second) => first.zip(second))(_.unzip)

    private given Codec[Track] = Codec
      .derived[(String, String, Vector[Long], Vector[Vector3], Vector[Vector3])]
      .imap((vehicle, role, steps, positions, velocities) =>
        val times = steps.scanLeft(0L)(_ + _).drop(1).map(Instant.ofNanos)
        Track.of(vehicle, role, times.lazyZip(positions).lazyZip(velocities).toVector)
      )(of =>
        val times = of.times.map(_.toNanos)
        (of.vehicle, of.role, times.zip(0L +: times).map(_ - _), of.positionsNed, of.velocitiesNed)
      )

    private given Codec[Distribution]      = doubles.imap(Distribution.of(_).get)(_.sorted)
    private given Codec[EventKind]         = Codec[String].imap(EventKind.valueOf)(_.toString)
    private given Codec[TimingObservation] = Codec[Int].imap(TimingObservation.fromOrdinal)(_.ordinal)
    private given events: Codec[Map[EventKind, Int]]                    = byKind
    private given observed: Codec[Map[TimingObservation, Distribution]] = byKind

    private given Codec[Simulator]        = Codec.derived
    private given Codec[FlightRow]        = Codec.derived
    private given Codec[NoResult]         = Codec.derived
    private given Codec[RoleSummary]      = Codec.derived
    private given Codec[PlanningSummary]  = Codec.derived
    private given Codec[PredictionErrors] = Codec.derived
    private given Codec[SolverSummary]    = Codec.derived
    private given Codec[Detection]        = Codec.derived
    private given Codec[Option[Scenario]] = Codec.of[Option[Scenario]]((_, _) => ())(_ => scenario)

    /** Omits the data of eyes that are not known here. */
    private given seeing: Codec[Vector[SeeingSummary]] = Codec
      .vector(using Codec.derived[(Int, Vector[Detection], Option[Int], Option[Distribution])])
      .imap(_.flatMap((eye, detections, images, ages) =>
        eyes.lift(eye).map(SeeingSummary(_, detections, images, ages))
      ))(_.map(of => (eyes.indexOf(of.eye), of.detections, of.images, of.agesMs)))

    val all: Codec[FlightSummary] = Codec.derived

    private def byKind[K <: reflect.Enum: Codec, V: Codec]: Codec[Map[K, V]] =
      Codec[Vector[(K, V)]].imap(_.toMap)(_.toVector.sortBy(_._1.ordinal))
