package skein.mavlink

class FrameReaderSuite extends munit.FunSuite:
  private val beat = FrameWriter(245, 190).write(Heartbeat(6, 8, 0, 0, 4, 3))

  /** A frame with this message in MAVLink 1. */
  private val older =
    val payload = Array[Byte](0, 0, 0, 0, 6, 8, 0, 4, 3)
    val frame   = Array[Byte](0xfe.toByte, 9, 0, 245.toByte, 190.toByte, 0) ++ payload
    val sum     = Checksum.Start.add(frame, 1, frame.length).add(50).value
    frame ++ Array(sum.toByte, (sum >> 8).toByte)

  test("only whole frames are recognised, of either version and at any position"):
    for bytes <- Seq(beat, older, Array[Byte](1, 2, 3) ++ beat, beat ++ beat.take(5)) do
      assert(FrameReader.isSpoken(bytes))
    for bytes <- Seq(Array.emptyByteArray, beat.take(beat.length - 1), older.init, Array.fill[Byte](100)(0))
    do
      assert(!FrameReader.isSpoken(bytes))

  test("bytes that look like a frame of an unknown message lose no frame after them"):
    for start <-
        Seq[Array[Int]](Array(0xfe, 200, 0, 1, 1, 0xf0), Array(0xfd, 200, 0, 0, 0, 1, 1, 0xee, 0xee, 0xee))
    do
      val reader = FrameReader()
      val frames = reader.read(start.map(_.toByte) ++ Array.fill(20)(beat).flatten)
      assertEquals(frames.size, 20)
      assertEquals(reader.counts.unknown, 1L)
