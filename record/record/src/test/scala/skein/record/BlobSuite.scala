package skein.record

class BlobSuite extends munit.FunSuite:
  private val bytes = Array.tabulate(1000)(_.toByte)

  test("contents are equal if their bytes are, compressed or not"):
    val blob = Blob.of(bytes)
    assertEquals(Blob.ofPacked(blob.packed), Right(blob))
    assertEquals(blob.compressed.bytes.toVector, bytes.toVector)
    assertEquals(blob.compressed.hashCode, blob.hashCode)
    assertNotEquals(Blob.of(bytes.updated(7, 0.toByte)), blob)

  test("an invalid or damaged frame, or one of too large a size, is refused before memory is allocated"):
    def refused(packed: Array[Byte]) = Blob.ofPacked(packed).left.getOrElse(fail("it was taken"))
    assert(refused(bytes).startsWith("expected a frame of Zstandard"), refused(bytes))
    val cut = Blob.of(bytes).packed.dropRight(20)
    assert(refused(cut).startsWith("a frame of Zstandard is damaged"), refused(cut))
    // A header alone: one segment, a size of eight bytes, 2^40.
    val huge = Array(0x28, 0xb5, 0x2f, 0xfd, 0xe0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0).map(_.toByte)
    assertEquals(refused(huge), s"expected up to ${Blob.MostBytes} bytes, got a frame of ${1L << 40}")

  test("a field of bytes is found among others, and is missing in a truncated message"):
    val message =
      Protobuf().varint(1, 300).text(2, "name").fixed32(3, 7).double(4, 1.5).bytes(6, bytes).result
    assertEquals(
      Protobuf.bytesOf(skein.mcap.Bytes.of(message), 6).map(_.toArray.toVector),
      Some(bytes.toVector)
    )
    for length <- 0 until message.length do
      assertEquals(Protobuf.bytesOf(skein.mcap.Bytes.of(message, 0, length), 6), None)
