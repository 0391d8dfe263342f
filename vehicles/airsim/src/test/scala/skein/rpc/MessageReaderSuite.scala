package skein.rpc

import scala.util.Random
import upack.*

class MessageReaderSuite extends munit.FunSuite:

  private def read[A](bytes: Array[Byte])(by: MessageReader => A): Either[String, A] =
    MessageReader.read(Received(bytes, 0))(by)

  test("any value that the oracle encodes is skipped to its end"):
    for seed <- 1 to 500 do
      val random = Random(seed)
      val bytes  = Wire.pack(Arr(Wire.randomMsg(random), Int32(77)))
      val after  = read(bytes): in =>
        in.array(): Unit
        in.skip()
        in.int()
      assertEquals(after, Right(77), s"seed $seed")

  test("integers are read from every encoding, and floats also from integers and doubles"):
    val edges = (0 to 62).flatMap(bit => Seq(1L << bit, -(1L << bit), (1L << bit) - 1))
    for edge <- edges do assertEquals(read(Wire.pack(Int64(edge)))(_.long()), Right(edge))
    val numbers = Arr(Float32(1.5f), Float64(-2.25), Int32(3), Int32(-4000))
    assertEquals(read(Wire.pack(numbers))(_.floats().toSeq), Right(Seq(1.5f, -2.25f, 3f, -4000f)))

  test("binary is returned without a copy"):
    val frame  = Wire.pack(Binary(Array[Byte](1, 2, 3)))
    val binary = read(frame)(_.binary()).fold(fail(_), identity)
    frame(frame.length - 1) = 9
    assertEquals(binary.toArray.toSeq, Seq[Byte](1, 2, 9))
    assert(binary.buffer.isReadOnly)
    intercept[IndexOutOfBoundsException](binary(3))

  test("binary and strings of every encoding are read whole, up to the last byte of a message"):
    for length <- Seq(0, 1, 31, 32, 255, 256, 65535, 65536) do
      val bytes = Array.fill[Byte](length)('a')
      for value <- Seq(Binary(bytes), Str("a" * length)) do
        assertEquals(read(Wire.pack(value))(_.binary().toArray.sameElements(bytes)), Right(true), s"$length")

  test("a map with more fields than the remaining bytes can hold is refused before any field is read"):
    for head <- Seq(Array(0xde, 0, 5), Array(0xdf, 0, 0, 0, 5)) do
      val map = (head ++ Array.fill(9)(0xc0)).map(_.toByte)
      assertEquals(
        read(map)(_.fields { case other => fail(other) }),
        Left("expected 5 more values or bytes, got 9 bytes")
      )

  test("an unexpected value is reported with its field"):
    val map = Wire.pack(Obj(Str("width") -> Str("wide")))
    assertEquals(
      read(map)(in => in.fields { case "width" => in.int(): Unit }),
      Left("width: expected an integer, got a value that begins with 0xa4")
    )

  test("mutated bytes throw nothing, and no memory is allocated for elements that cannot exist"):
    for seed <- 1 to 20_000 do
      val random = Random(seed)
      val bytes  = Mutation.of(random, Mutation.request)
      for by <- Seq[MessageReader => Any](
          _.skip(),
          _.floats(),
          _.ints(),
          _.binary(),
          _.fields { case "a" => () }
        )
      do assert(read(bytes)(by).fold(_.nonEmpty, _ => true), s"seed $seed")
    val huge = Array(0xdd, 0x7f, 0xff, 0xff, 0xff, 1).map(_.toByte)
    assertEquals(
      read(huge)(_.floats().length),
      Left("expected 2147483647 more values or bytes, got 1 bytes")
    )
