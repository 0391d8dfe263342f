package skein.mavlink

import scala.util.Random

class RoundTripLaws extends munit.FunSuite:

  test("written frames are read back for any segmentation of the stream"):
    val random = Random(1)
    for _ <- 1 to 300 do
      val sent   = Vector.fill(1 + random.nextInt(8))(RandomMessage.draw(random))
      val writer = FrameWriter(1 + random.nextInt(255), 1 + random.nextInt(255))
      val stream = sent.flatMap(writer.write).toArray
      val reader = FrameReader()
      val piece  = 1 + random.nextInt(60)
      val read   = stream.grouped(piece).flatMap(reader.read).toVector
      assertEquals(read.map(_.message), sent)
      assertEquals(read.map(_.sequence), sent.indices.toVector)
      assertEquals(reader.counts, ReaderCounts(frames = sent.size))

  test("trailing zeros of a payload are not sent, except for one byte"):
    val writer = FrameWriter(1, 1)
    assertEquals(writer.write(Timesync(0, 5)).length, 10 + 9 + 2)
    assertEquals(writer.write(MissionItemReached(0)).length, 10 + 1 + 2)

  test("a payload longer than the known fields is read up to their end"):
    val heartbeat = Heartbeat(2, 12, 81, 1, 4, 3)
    val longer    = Dialect.of(heartbeat).encode(heartbeat) ++ Array[Byte](1, 2, 3)
    assertEquals(Dialect.of(heartbeat).decode(longer), heartbeat)

  test("text that is too long is cut"):
    val text = Statustext(6, "x" * 60)
    assertEquals(
      FrameReader().read(FrameWriter(1, 1).write(text)).map(_.message),
      Vector(text.copy(text = "x" * 50))
    )

  test("lost frames are counted by the sequence numbers"):
    val writer = FrameWriter(1, 1)
    val sent   = Vector.tabulate(600)(index => writer.write(MissionItemReached(index)))
    val reader = FrameReader()
    sent.zipWithIndex.foreach((frame, index) => if index % 10 != 3 then reader.read(frame): Unit)
    assertEquals(reader.counts, ReaderCounts(frames = 540, lost = 60))
