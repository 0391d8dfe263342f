package skein.ros.message

import scala.collection.immutable.ArraySeq

class CdrSuite extends munit.FunSuite:
  private case class Mixed(a: Byte, b: Double, c: Boolean, d: Short, e: String, f: Vector[Vector3])
      derives Cdr

  private val mixed = Mixed(1, -2.5, c = true, 3, "ä", Vector(Vector3(1, 2, 3)))

  private def refused[A: Cdr](bytes: Array[Byte]): String =
    Cdr.message[A](bytes).swap.getOrElse(fail("was read"))

  private def little(body: Int*): Array[Byte] = Array[Byte](0, 1, 0, 0) ++ body.map(_.toByte)

  test("numbers are aligned to their size, counted after the four bytes of the header"):
    val bytes = Cdr.bytes(mixed)
    assertEquals(bytes.take(4).toSeq, Seq[Byte](0, 1, 0, 0))
    assertEquals(bytes.slice(4, 12).toSeq, Seq[Byte](1, 0, 0, 0, 0, 0, 0, 0))
    assertEquals(bytes.length, 4 + 8 + 8 + 1 + 1 + 2 + 4 + 3 + 5 + 24)
    assertEquals(Cdr.message[Mixed](bytes), Right(mixed))

  test("an empty text may lack its final zero, and any other text must have it"):
    assertEquals(Cdr.message[String](little(0, 0, 0, 0)), Right(""))
    assertEquals(Cdr.message[String](little(1, 0, 0, 0, 0)), Right(""))
    assertEquals(refused[String](little(1, 0, 0, 0, 65)), "expected a text that ends with 0 at byte 4")

  test("up to three bytes of padding may follow a message, and more are refused"):
    assertEquals(Cdr.message[Int](little(7, 0, 0, 0, 9, 9, 9)), Right(7))
    assertEquals(
      refused[Int](little(7, 0, 0, 0, 9, 9, 9, 9)),
      "expected the message's end, got 4 more bytes"
    )

  test("a message that is cut off anywhere is refused, with the position"):
    val bytes = Cdr.bytes(mixed)
    for length <- 0 until bytes.length do
      assert(refused[Mixed](bytes.take(length)).startsWith("expected"), length)
    assertEquals(refused[Mixed](bytes.take(12)), "expected 8 more bytes at byte 8, the message ends at 8")

  test("another encoding than plain CDR is refused"):
    assertEquals(
      refused[Int](Array[Byte](0, 7, 0, 0, 1, 0, 0, 0)),
      "expected plain CDR, 0x0000 or 0x0001, got 0x0007"
    )

  test("a count beyond the bytes that are left is refused before anything is allocated"):
    val most = Seq(255, 255, 255, 255)
    assertEquals(
      refused[ArraySeq[Byte]](little(most*)),
      "expected a count of 0 to 0 at byte 0, got 4294967295"
    )
    assertEquals(
      refused[Vector[Vector3]](little(0, 0, 0, 127, 0)),
      "expected a count of 0 to 1 at byte 0, got 2130706432"
    )
    assertEquals(
      refused[ArraySeq[Double]](little(2, 0, 0, 0, 0, 0, 0, 0, 0, 0)),
      "expected a count of 0 to 0 at byte 0, got 2"
    )

  test("a boolean is 0 or 1"):
    assertEquals(refused[Boolean](little(2)), "expected 0 or 1 at byte 0, got 2")

  test("a buffer grows with its message"):
    val image = Image(Header(Time(0, 0), ""), 1000, 1000, "rgb8", 0, 3000, ArraySeq.fill[Byte](3_000_000)(5))
    assertEquals(Cdr.message[Image](Cdr.bytes(image)), Right(image))

  test("an array has exactly the number of elements of its type"):
    assertEquals(Doubles.zero[9].values.size, 9)
    val error = intercept[IllegalArgumentException](Doubles.of[9](Seq(1.0)))
    assert(error.getMessage.contains("expected 9 numbers, got 1"))

  test("times before and after the epoch keep their nanoseconds"):
    for nanos <- Seq(0L, 1L, -1L, 1_700_000_000_123_456_789L, -1_500_000_000L) do
      val time = Time.of(skein.units.Instant.ofNanos(nanos))
      assert(time.nanosec >= 0 && time.nanosec < 1_000_000_000, time)
      assertEquals(time.instant.toNanos, nanos)
