package skein.cluster

import java.nio.ByteBuffer
import java.nio.ByteOrder.LITTLE_ENDIAN

class FrameCheckSuite extends munit.FunSuite:
  private val most = 1000

  private def connection(lengths: Int*): Array[Byte] =
    val bytes =
      ByteBuffer.allocate(5 + lengths.map(length => 4 + length.max(0).min(most)).sum).order(LITTLE_ENDIAN)
    bytes.put("AKKA".getBytes("US-ASCII")).put(1.toByte): Unit
    for length <- lengths do bytes.putInt(length).put(Array.fill(length.max(0).min(most))(-1.toByte)): Unit
    bytes.array

  /** Checks the bytes in pieces of each size; the results must agree. */
  private def refused(bytes: Array[Byte]): Option[Int] =
    val found = (1 to bytes.length).map: size =>
      val check = FrameCheck(most)
      bytes.grouped(size).flatMap(piece => check.refused(ByteBuffer.wrap(piece))).nextOption()
    assertEquals(found.distinct.size, 1)
    found.head

  test("frames of allowed length pass, with any content and any segmentation"):
    assertEquals(refused(connection(0, 1, 7, most, 0, 300)), None)

  test("an invalid length is detected even after valid ones: negative, too large, close to 2³¹"):
    for length <- Seq(-1, Int.MinValue, most + 1, Int.MaxValue, Int.MaxValue - 8) do
      assertEquals(refused(connection(length)), Some(length))
      assertEquals(refused(connection(3, most, length)), Some(length))

  test("the check does not consume the buffer's bytes"):
    val bytes = ByteBuffer.wrap(connection(4))
    assertEquals(FrameCheck(most).refused(bytes), None)
    assertEquals(bytes.position(), 0)
