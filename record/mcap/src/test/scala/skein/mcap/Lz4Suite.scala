package skein.mcap

import java.io.{ByteArrayInputStream, ByteArrayOutputStream}
import java.util.{HexFormat, SplittableRandom}
import net.jpountz.lz4.{LZ4Factory, LZ4FrameInputStream, LZ4FrameOutputStream}
import net.jpountz.xxhash.XXHashFactory

class Lz4Suite extends munit.FunSuite:

  private def draw(seed: Long, most: Int): Array[Byte] =
    val random = SplittableRandom(seed)
    val out    = ByteArrayOutputStream()
    val length = random.nextInt(most)
    while out.size < length do
      val part = new Array[Byte](1 + random.nextInt(300))
      random.nextInt(3) match
        case 0 => random.nextBytes(part)
        case 1 => java.util.Arrays.fill(part, random.nextInt(3).toByte)
        case _ =>
          val before = out.toByteArray
          if before.nonEmpty then
            val from = random.nextInt(before.length)
            System.arraycopy(before, from, part, 0, part.length.min(before.length - from))
      out.write(part)
    out.toByteArray

  test("lz4-java's own reader reads the written frames"):
    for seed <- 1L to 100 do
      val source = draw(seed, 200_000)
      val frame  = Lz4Frame.compress(source, 0, source.length).toArray
      val read   = LZ4FrameInputStream(ByteArrayInputStream(frame)).readAllBytes()
      assert(java.util.Arrays.equals(read, source), s"seed $seed")

  test("frames with blocks of every size, with checksums and without, are read"):
    for
      seed <- 1L to 50
      size <- LZ4FrameOutputStream.BLOCKSIZE.values
    do
      import LZ4FrameOutputStream.FLG.Bits.{BLOCK_CHECKSUM, BLOCK_INDEPENDENCE, CONTENT_CHECKSUM}
      val source   = draw(seed, 200_000)
      val out      = ByteArrayOutputStream()
      val features = if seed % 2 == 0 then Seq(BLOCK_CHECKSUM, CONTENT_CHECKSUM) else Seq.empty
      val frames   = LZ4FrameOutputStream(out, size, (BLOCK_INDEPENDENCE +: features)*)
      frames.write(source)
      frames.close()
      val read = Lz4Frame.decompress(Bytes.of(out.toByteArray), source.length, cut = false)
      assertEquals(read, Bytes.of(source), s"seed $seed, $size")

  test("only the given part of an array is compressed"):
    val source = draw(9, 4000)
    val half   = source.length / 2
    val frame  = Lz4Frame.compress(source, half, source.length)
    assertEquals(Lz4Frame.decompress(frame, source.length - half, cut = false), Bytes.of(source.drop(half)))

  test("blocks that refer to the previous one are read, with checksums of blocks and content"):
    // Python's lz4.frame.compress(…, block_size=64 kB, block_linked=True, block_checksum=True,
    // content_checksum=True).
    val frame = HexFormat.of.parseHex(
      "04224d185c40880d0100000000004622010000ff086162636465666768696a6b6c6d6e6f70717273747576771700" + "f" * 512 +
        "d15065666768694598558f170000000ff7ffffffffffffffffffffffffffff7d50737475767707ec691f00000000b3086cb0"
    )
    val source = Array.tabulate(69000)(at => ('a' + at % 23).toByte)
    assertEquals(Lz4Frame.decompress(Bytes.of(frame), source.length, cut = false), Bytes.of(source))
    val changed = frame.clone
    changed(changed.length - 1) = 0
    intercept[Damaged](Lz4Frame.decompress(Bytes.of(changed), source.length, cut = false))

  /** A frame of linked blocks, each given as its bytes. */
  private def linked(blocks: Array[Byte]*): Bytes =
    val head = Array[Byte](0x40, 0x40)
    val sum  = XXHashFactory.safeInstance.hash32.hash(head, 0, 2, 0) >>> 8
    val out  = ByteBuilder(64)
    out.u32(0x184d2204)
    out.raw(Bytes.of(head))
    out.u8(sum)
    blocks.foreach: block =>
      out.u32(block.length)
      out.raw(Bytes.of(block))
    out.u32(0)
    Bytes.of(out.array, 0, out.size)

  test("a block may refer to fewer bytes than a match is long, and up to 65,535 bytes back"):
    // A match ends some bytes before its block, as LZ4 requires.
    val last  = Array.tabulate[Byte](9)(at => (4 + at).toByte)
    val short = linked(Array[Byte](0x30, 1, 2, 3), Array[Byte](0, 3, 0, -0x70) ++ last)
    assertEquals(
      Lz4Frame.decompress(short, 16, cut = false),
      Bytes.of(Array[Byte](1, 2, 3, 1, 2, 3, 1) ++ last)
    )
    val first = new Array[Byte](65536)
    SplittableRandom(1).nextBytes(first)
    val packed = LZ4Factory.safeInstance.fastCompressor.compress(first)
    val far    = linked(packed, Array[Byte](0, -1, -1, -0x70) ++ last)
    val read   = Lz4Frame.decompress(far, first.length + 13, cut = false).toArray
    assertEquals(read.drop(first.length).toVector, first.slice(1, 5).toVector ++ last)

  test("the blocks before the cut of a truncated frame are read"):
    val source = draw(3, 1) ++ Array.tabulate(300_000)(at => (at * at >>> 9).toByte)
    val frame  = Lz4Frame.compress(source, 0, source.length)
    for length <- 0 until frame.size by 997 do
      val read = Lz4Frame.decompress(frame.slice(0, length), source.length, cut = true)
      assert(read.size % 65536 == 0 && read == Bytes.of(source).slice(0, read.size), s"cut at $length")
    val most = Lz4Frame.decompress(frame.slice(0, frame.size - 5), source.length, cut = true)
    assertEquals(most.size, source.length - source.length % 65536)
