package skein.mavlink

class SigningSuite extends munit.FunSuite:
  private val key                             = Array.fill[Byte](32)(9)
  private var now                             = 1_000_000_000L
  private def signing(key: Array[Byte] = key) = Signing(key, 1, () => now)
  private val message                         = CommandLong(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)

  private def refused(reader: FrameReader, bytes: Array[Byte]): Unit =
    assertEquals(reader.read(bytes), Vector.empty)
    assertEquals(reader.counts, ReaderCounts(frames = reader.counts.frames, badSignature = 1))

  test("a signed frame is accepted with the right key, and refused with a wrong key or without a key"):
    val bytes = FrameWriter(1, 1, Some(signing())).write(message)
    assertEquals(FrameReader(Some(signing())).read(bytes), Vector(Frame(1, 1, 0, message, isSigned = true)))
    refused(FrameReader(Some(signing(Array.fill[Byte](32)(8)))), bytes)
    refused(FrameReader(Some(signing())), FrameWriter(1, 1).write(message))

  test("a signed frame is read by a reader without signing"):
    val bytes = FrameWriter(1, 1, Some(signing())).write(message)
    assertEquals(FrameReader().read(bytes ++ bytes).map(_.message), Vector(message, message))

  test("a replayed frame is refused"):
    val bytes  = FrameWriter(1, 1, Some(signing())).write(message)
    val reader = FrameReader(Some(signing()))
    assertEquals(reader.read(bytes).size, 1)
    refused(reader, bytes)

  test("a first frame that is older than a minute is refused"):
    val bytes = FrameWriter(1, 1, Some(signing())).write(message)
    now += 6_000_001
    refused(FrameReader(Some(signing())), bytes)

  test("times of signatures are computed from Unix time"):
    assertEquals(Signing.timeOf(1_420_070_400_000L), 0L)
    assertEquals(Signing.timeOf(1_420_070_401_000L), 100_000L)
