package skein.mavlink

import scala.util.Random

/** Streams that are similar to, or very different from, what a peer should send. */
class FuzzSuite extends munit.FunSuite:

  test("damaged frames of each kind are refused or still valid, and the next frames are read"):
    for (definition, kind) <- Dialect.all.zipWithIndex do
      val random = Random(kind)
      val writer = FrameWriter(1, 1)
      // Enough bytes to end any damaged frame, whatever its stated length.
      val after = Vector.tabulate(25)(index => ParamRequestList(index, 0))
      val tail  = after.flatMap(writer.write).toArray
      var whole = 0
      for round <- 1 to 250 do
        val message = RandomMessage.draw(definition, random)
        val frame   = writer.write(message)
        val damaged = mutated(frame, random)
        val reader  = FrameReader()
        val read    = reader.read(damaged ++ tail).map(_.message)
        assertEquals(read.takeRight(2), after.takeRight(2), s"${definition.name}, round $round")
        whole += read.count(_ == message)
      assert(whole < 125, s"${definition.name}: $whole of 250 were not damaged")

  test("noise gives equal frames and counts whether it is read byte by byte or in one piece"):
    val random = Random(7)
    for _ <- 1 to 200 do
      val noise            = random.nextBytes(random.nextInt(2000))
      val (atOnce, byByte) = (FrameReader(), FrameReader())
      val frames           = atOnce.read(noise)
      assertEquals(noise.grouped(1).flatMap(byByte.read).toVector, frames)
      assertEquals(byByte.counts, atOnce.counts)

  test("a frame with unknown flags or an unknown message is counted and skipped"):
    val writer  = FrameWriter(1, 1)
    val good    = writer.write(MissionItemReached(1))
    val flagged = good.updated(2, 0x02.toByte)
    val strange = good.updated(9, 0x7f.toByte)
    val reader  = FrameReader()
    assertEquals(reader.read(flagged ++ strange ++ good).map(_.message), Vector(MissionItemReached(1)))
    assertEquals((reader.counts.notUnderstood, reader.counts.unknown), (1L, 1L))

  test("frames of MAVLink 1 are counted, not read"):
    val version1 = java.util.HexFormat.of().parseHex("fe0900010100000000000203510403")
    val payload  = version1.drop(1)
    val sum      = Checksum.Start.add(payload).add(50).value
    val reader   = FrameReader()
    assertEquals(reader.read(version1 ++ Array(sum.toByte, (sum >> 8).toByte)), Vector.empty)
    assertEquals(reader.counts, ReaderCounts(version1 = 1))

  test("a frame of MAVLink 1 with an unknown message is counted as such, and what follows is read"):
    val strange = java.util.HexFormat.of().parseHex("fe0300010180fefdfe0000")
    val good    = FrameWriter(1, 1).write(MissionItemReached(1))
    val reader  = FrameReader()
    assertEquals(reader.read(strange ++ strange ++ good).map(_.message), Vector(MissionItemReached(1)))
    assertEquals(reader.counts, ReaderCounts(frames = 1, unknown = 2))

  test("an unfinished frame of a datagram does not continue in the next datagram"):
    val frame  = FrameWriter(1, 1).write(MissionItemReached(1))
    val reader = FrameReader()
    assertEquals(reader.readDatagram(frame.dropRight(3)), Vector.empty)
    assertEquals(reader.readDatagram(frame).map(_.message), Vector(MissionItemReached(1)))
    assertEquals(reader.counts.garbageBytes, frame.length - 3L)

  private def mutated(bytes: Array[Byte], random: Random): Array[Byte] =
    val at = random.nextInt(bytes.length)
    random.nextInt(7) match
      case 0 => bytes.updated(at, (bytes(at) ^ (1 << random.nextInt(8))).toByte)
      case 1 => bytes.take(at)
      case 2 => bytes.take(at) ++ random.nextBytes(1 + random.nextInt(8)) ++ bytes.drop(at)
      case 3 => bytes.take(at) ++ bytes.drop(at + 1 + random.nextInt(8))
      case 4 => bytes.updated(1, random.nextInt(256).toByte)
      case 5 => bytes.updated(7 + random.nextInt(3), random.nextInt(256).toByte)
      case _ => random.nextBytes(bytes.length)
