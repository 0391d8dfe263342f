package skein.mcap

import java.util.SplittableRandom

/** Files that are truncated, changed, or malicious. */
class DamageLaws extends munit.FunSuite:

  test("a file truncated at any byte yields everything before the cut"):
    for seed <- 1L to 4 do
      val file  = RandomFile.draw(seed, most = 40)
      val whole = Parsing.all(file.bytes)
      for length <- places(file) do
        val cut  = file.bytes.slice(0, length)
        val read = Parsing.all(cut, piece = 1 + length % 97)
        val what = s"${file.show}, cut at $length"
        read.end match
          case Parsed.Failed(McapError.CutOff(at, _, _)) => assert(at.offset <= length, what)
          case Parsed.Failed(McapError.NotMcap(_))       => assert(length == 0, what)
          case other                                     => fail(s"$what: $other")
        // All records that end before the cut; of truncated chunks, their complete records.
        val before = whole.found.filter(found => endOf(found, whole) <= length).map(_.record)
        val came   = read.records
        assertEquals(came.take(before.size), before, what)
        assertEquals(came.drop(before.size), rest(whole, before.size, came.size - before.size), what)

  test("every complete message of a truncated uncompressed chunk is read"):
    for seed <- 1L to 6 do
      val file =
        RandomFile.draw(
          seed,
          options = _ => WriterOptions(chunkBytes = 4000, compression = Compression.Uncompressed)
        )
      val whole = Parsing.all(file.bytes)
      val heads = whole.found.collect { case Parsed.Found(chunk: Record.Chunk, at, length) =>
        at.offset -> (at.offset + length - chunk.records.size)
      }.toMap
      for length <- places(file) do
        val expected = whole.found.collect:
          case Parsed.Found(message: Record.Message, at, size)
              if heads(at.offset) + at.inChunk + size <= length =>
            message
        assertEquals(
          Parsing.all(file.bytes.slice(0, length)).messages,
          expected,
          s"${file.show}, cut at $length"
        )

  test("a changed byte anywhere is detected, and the error names its position"):
    for seed <- 1L to 5 do
      val file   = RandomFile.draw(seed, most = 40)
      val random = SplittableRandom(seed)
      for at <- places(file) do
        val changed = file.bytes.toArray
        changed(at) = (changed(at) ^ (1 << random.nextInt(8))).toByte
        val what = s"${file.show}, changed at $at"
        Parsing.all(Bytes.of(changed)).end match
          case Parsed.Failed(error) => assert(error.message.startsWith("byte "), s"$what: $error")
          case other                => fail(s"$what: $other")

  test("for any bytes, a reader returns records or the reason why it cannot"):
    for seed <- 1L to 400 do
      val random  = SplittableRandom(seed)
      val file    = RandomFile.draw(seed % 50, most = 30)
      val changed = file.bytes.toArray
      for _ <- 0 to random.nextInt(6) do
        val at = random.nextInt(changed.length)
        // Wrong lengths do most harm: bytes of all ones are frequent.
        changed(at) = (if random.nextInt(3) == 0 then 0xff else random.nextInt(256)).toByte
      val bytes = Bytes.of(changed)
      try Parsing.all(bytes, limits = McapLimits(recordBytes = 1 << 16, chunkBytes = 1 << 16)).end: Unit
      catch case error: Throwable => throw AssertionError(s"seed $seed: $error", error)

  test("damaged lz4 or zstd data are refused or yield no more than the stated size, and never crash the JVM"):
    for seed <- 1L to 1000 do
      val random = SplittableRandom(seed)
      val source = new Array[Byte](random.nextInt(400))
      if random.nextInt(2) == 0 then random.nextBytes(source)
      val kind   = if random.nextInt(2) == 0 then Compression.Lz4 else Compression.Zstd()
      val packed = kind.compress(source, 0, source.length).toArray
      for _ <- 0 to random.nextInt(3) do packed(random.nextInt(packed.length)) = random.nextInt(256).toByte
      val claimed = random.nextInt(500)
      val chunk   = Record.Chunk(0, 0, claimed, 0, kind.name, Bytes.of(packed))
      for cut <- Vector(false, true) do
        try
          Refused
            .either(Compression.decompress(chunk, McapLimits(), Place(0), cut))
            .foreach(held => assert(held.size <= claimed, s"seed $seed"))
        catch case error: Throwable => throw AssertionError(s"seed $seed, cut $cut: $error", error)

  /** Positions to test: every byte of the first two files, of the others every seventh. */
  private def places(file: RandomFile): Range =
    val step = if file.seed <= 2 then 1 else 7
    (file.seed % step).toInt until file.bytes.size by step

  /** The end of a record in the file; for a record in a chunk, the end of the chunk. */
  private def endOf(found: Parsed.Found, whole: Parsing): Long =
    if found.at.inChunk < 0 then found.at.offset + found.length
    else
      whole.found.collectFirst {
        case Parsed.Found(_: Record.Chunk, at, length) if at.offset == found.at.offset => at.offset + length
      }.get

  /** The next `count` records, as a truncated chunk yields them: without the chunk itself. */
  private def rest(whole: Parsing, from: Int, count: Int): Vector[Record] =
    whole.records.drop(from).dropWhile(_.opcode == Opcode.Chunk).take(count)
