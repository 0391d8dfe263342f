package skein.ros.message

import scala.collection.immutable.ArraySeq
import scala.compiletime.summonAll
import scala.deriving.Mirror

/** Writes values as CDR, the encoding of ROS 2's messages, and reads them back to the bit. A case class is
  * written as its fields in order. `Int` stands for `int32` and `uint32`, `Short` and `Byte` likewise for
  * both signs.
  *
  * Source: OMG DDS-XTypes 1.3, 7.4.3 (XCDR1). `MessageGolden` compares with bytes that `rclpy` writes.
  */
trait Cdr[A]:
  def write(value: A, to: CdrWriter): Unit

  /** @throws CdrError if the bytes encode no such value; only [[Cdr.message]] calls it */
  def read(from: CdrReader): A

object Cdr:
  /** Bytes after a message's end that are ignored: padding to a multiple of four. */
  private val MostPadding = 3

  /** Writes a message with the four bytes that state its encoding, little-endian.
    *
    * @throws IllegalArgumentException beyond 1 GiB
    */
  def bytes[A](value: A)(using cdr: Cdr[A]): Array[Byte] =
    val to = CdrWriter()
    cdr.write(value, to)
    to.result

  /** Reads a message in either byte order.
    *
    * @return Left says what was expected, what was found, and at which byte after the first four
    */
  def message[A](bytes: Array[Byte])(using cdr: Cdr[A]): Either[String, A] =
    try
      val from = CdrReader.of(bytes)
      val read = cdr.read(from)
      Either.cond(from.rest <= MostPadding, read, s"expected the message's end, got ${from.rest} more bytes")
    catch case error: CdrError => Left(error.getMessage)

  def of[A](put: (A, CdrWriter) => Unit)(take: CdrReader => A): Cdr[A] = new Cdr[A]:
    def write(value: A, to: CdrWriter): Unit = put(value, to)
    def read(from: CdrReader): A             = take(from)

  given Cdr[Boolean] = of[Boolean]((value, to) => to.boolean(value))(_.boolean())
  given Cdr[Byte]    = of[Byte]((value, to) => to.byte(value))(_.byte())
  given Cdr[Short]   = of[Short]((value, to) => to.short(value))(_.short())
  given Cdr[Int]     = of[Int]((value, to) => to.int(value))(_.int())
  given Cdr[Float]   = of[Float]((value, to) => to.float(value))(_.float())
  given Cdr[Double]  = of[Double]((value, to) => to.double(value))(_.double())
  given Cdr[String]  = of[String]((value, to) => to.text(value))(_.text())

  given byteSequence: Cdr[ArraySeq[Byte]]     = packed(1)(_.bytes(_), _.bytes(_))
  given floatSequence: Cdr[ArraySeq[Float]]   = packed(4)(_.floats(_), _.floats(_))
  given doubleSequence: Cdr[ArraySeq[Double]] = packed(8)(_.doubles(_), _.doubles(_))

  private def packed[A](bytesEach: Int)(
      put: (CdrWriter, ArraySeq[A]) => Unit,
      take: (CdrReader, Int) => ArraySeq[A]
  ) = of[ArraySeq[A]]((values, to) =>
    to.int(values.size)
    put(to, values)
  )(from => take(from, from.count(bytesEach)))

  /** A sequence of messages. None is empty, so each takes a byte at least. */
  given sequence[A](using cdr: Cdr[A]): Cdr[Vector[A]] = of[Vector[A]]((values, to) =>
    to.int(values.size)
    values.foreach(cdr.write(_, to))
  )(from => Vector.fill(from.count(1))(cdr.read(from)))

  /** The encoding of a case class whose fields have encodings. */
  inline def derived[A](using mirror: Mirror.ProductOf[A]): Cdr[A] =
    ofFields(mirror, summonAll[Tuple.Map[mirror.MirroredElemTypes, Cdr]])

  private[message] def ofFields[A](mirror: Mirror.ProductOf[A], fields: Tuple): Cdr[A] =
    val each = fields.productIterator.map(_.asInstanceOf[Cdr[Any]]).toList
    of[A]((value, to) =>
      for (field, cdr) <- value.asInstanceOf[Product].productIterator.zip(each) do cdr.write(field, to)
    )(from => mirror.fromProduct(Tuple.fromArray(each.map(_.read(from)).toArray[Any])))
