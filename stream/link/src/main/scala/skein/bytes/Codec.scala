package skein.bytes

import java.io.{
  ByteArrayInputStream,
  ByteArrayOutputStream,
  DataInputStream,
  DataOutputStream,
  EOFException,
  IOException
}
import java.util.Locale
import scala.collection.immutable.ArraySeq
import scala.compiletime.{constValue, erasedValue, summonAll, summonInline}
import scala.deriving.Mirror
import skein.units.*

/** Encodes values as bytes, and decodes them exactly: numbers big-endian, texts in UTF-8 after their length
  * in bytes, lists after their length, optional values after a byte that states whether they exist; a case
  * class by its fields in order; an enum by a byte for the case, from 1, then that case's fields.
  */
trait Codec[A]:
  def write(value: A, out: DataOutputStream): Unit

  /** @throws IOException if the bytes encode no such value, or contain a length beyond the bytes left */
  def read(in: DataInputStream): A

  /** A codec of another type with an equal encoding. */
  final def imap[B](to: A => B)(from: B => A): Codec[B] =
    Codec.of[B]((value, out) => write(from(value), out))(in => to(read(in)))

object Codec:
  def apply[A](using codec: Codec[A]): Codec[A] = codec

  def of[A](put: (A, DataOutputStream) => Unit)(take: DataInputStream => A): Codec[A] = new Codec[A]:
    def write(value: A, out: DataOutputStream): Unit = put(value, out)
    def read(in: DataInputStream): A                 = take(in)

  def bytes[A](value: A)(using codec: Codec[A]): Array[Byte] =
    val into = ByteArrayOutputStream(1024)
    codec.write(value, DataOutputStream(into))
    into.toByteArray

  /** Decodes a message that fills the bytes.
    *
    * @return Left says what was expected and what was received
    */
  def message[A](bytes: Array[Byte])(using codec: Codec[A]): Either[String, A] =
    val in = DataInputStream(ByteArrayInputStream(bytes))
    try
      val read = codec.read(in)
      Either.cond(in.available == 0, read, s"expected the message's end, got ${in.available} more bytes")
    catch
      case _: EOFException    => Left(s"the message is cut off after ${bytes.length} bytes")
      case wrong: IOException => Left(wrong.getMessage)

  /** Reads a length, which must not exceed the bytes left. */
  def length(in: DataInputStream, atMost: Int = Int.MaxValue): Int =
    val came = in.readInt()
    val most = atMost.min(in.available)
    if came < 0 || came > most then throw IOException(s"expected a length of 0 to $most, got $came")
    came

  /** A byte array after its length.
    *
    * @throws IllegalArgumentException when writing more than `most`
    */
  def blob(most: Int): Codec[Array[Byte]] = of[Array[Byte]]((value, out) =>
    require(value.length <= most, s"a part of a message has ${value.length} bytes, at most $most go")
    out.writeInt(value.length)
    out.write(value)
  )(in => in.readNBytes(length(in, most)))

  given Codec[Boolean]         = of[Boolean]((value, out) => out.writeBoolean(value))(_.readBoolean())
  given Codec[Int]             = of[Int]((value, out) => out.writeInt(value))(_.readInt())
  given Codec[Long]            = of[Long]((value, out) => out.writeLong(value))(_.readLong())
  given Codec[Double]          = of[Double]((value, out) => out.writeDouble(value))(_.readDouble())
  given Codec[String]          = blob(Int.MaxValue).imap(String(_, "UTF-8"))(_.getBytes("UTF-8"))
  given Codec[ArraySeq[Byte]]  = blob(Int.MaxValue).imap(ArraySeq.unsafeWrapArray)(_.toArray)
  given Codec[Instant]         = Codec[Long].imap[Instant](Instant.ofNanos(_))(_.toNanos)
  given Codec[Span]            = Codec[Long].imap[Span](Span.ofNanos(_))(_.toNanos)
  given Codec[Metres]          = Codec[Double].imap[Metres](Metres(_))(_.value)
  given Codec[MetresPerSecond] = Codec[Double].imap[MetresPerSecond](MetresPerSecond(_))(_.value)
  given Codec[Radians]         = Codec[Double].imap[Radians](Radians(_))(_.value)
  given Codec[Vector3]         = derived
  given Codec[Quaternion]      = derived

  given option[A](using codec: Codec[A]): Codec[Option[A]] = of[Option[A]]((value, out) =>
    out.writeBoolean(value.isDefined)
    value.foreach(codec.write(_, out))
  )(in => Option.when(in.readBoolean())(codec.read(in)))

  given vector[A](using codec: Codec[A]): Codec[Vector[A]] = of[Vector[A]]((value, out) =>
    out.writeInt(value.size)
    value.foreach(codec.write(_, out))
  )(in => Vector.fill(length(in))(codec.read(in)))

  given pair[A, B](using Codec[A], Codec[B]): Codec[(A, B)] = derived

  given either[A, B](using Codec[A], Codec[B]): Codec[Either[A, B]] = derived

  /** A named tuple, encoded as the tuple without names. */
  given named[N <: Tuple, V <: Tuple](using codec: Codec[V]): Codec[NamedTuple.NamedTuple[N, V]] =
    codec.asInstanceOf[Codec[NamedTuple.NamedTuple[N, V]]]

  /** The codec of a case class or an enum, whose fields have codecs. */
  inline def derived[A](using mirror: Mirror.Of[A]): Codec[A] = inline mirror match
    case product: Mirror.ProductOf[A] =>
      ofFields(product, summonAll[Tuple.Map[product.MirroredElemTypes, Codec]])
    case sum: Mirror.SumOf[A] =>
      ofCases(constValue[sum.MirroredLabel], sum, cases[sum.MirroredElemTypes])

  private inline def cases[T <: Tuple]: List[Codec[Any]] = inline erasedValue[T] match
    case _: EmptyTuple     => Nil
    case _: (head *: tail) =>
      derived[head](using summonInline[Mirror.Of[head]]).asInstanceOf[Codec[Any]] :: cases[tail]

  private[skein] def ofFields[A](product: Mirror.ProductOf[A], fields: Tuple): Codec[A] =
    val codecs = fields.productIterator.map(_.asInstanceOf[Codec[Any]]).toList
    of[A]((value, out) =>
      for (field, codec) <- value.asInstanceOf[Product].productIterator.zip(codecs) do codec.write(field, out)
    )(in => product.fromProduct(Tuple.fromArray(codecs.map(_.read(in)).toArray[Any])))

  private[skein] def ofCases[A](label: String, sum: Mirror.SumOf[A], cases: List[Codec[Any]]): Codec[A] =
    val all = cases.toVector
    of[A]((value, out) =>
      val number = sum.ordinal(value)
      out.writeByte(number + 1)
      all(number).write(value, out)
    ): in =>
      val kind = in.readUnsignedByte()
      if kind < 1 || kind > all.size then
        val what = label.replaceAll("(?<=.)([A-Z])", " $1").toLowerCase(Locale.ROOT)
        throw IOException(s"expected a kind of $what from 1 to ${all.size}, got $kind")
      all(kind - 1).read(in).asInstanceOf[A]
