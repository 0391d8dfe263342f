package skein.mcap

import java.io.{ByteArrayInputStream, ByteArrayOutputStream}
import java.util.{HexFormat, SplittableRandom}
import net.jpountz.lz4.{LZ4FrameInputStream, LZ4FrameOutputStream}
import net.jpountz.xxhash.XXHashFactory

/** Frames of LZ4, held against another implementation's. */
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

  test("what is compressed, the other implementation reads"):
    for seed <- 1L to 400 do
      val source = draw(seed, 5000)
      val frame  = Lz4Frame.compress(source, 0, source.length).toArray
      val read   = LZ4FrameInputStream(ByteArrayInputStream(frame)).readAllBytes()
      assertEquals(read.toVector, source.toVector, s"seed $seed")

  test("what the other implementation compresses is read"):
    for seed <- 1L to 400 do
      val source = draw(seed, 5000)
      val out    = ByteArrayOutputStream()
      val frames = LZ4FrameOutputStream(out, LZ4FrameOutputStream.BLOCKSIZE.SIZE_64KB)
      frames.write(source)
      frames.close()
      val read = Lz4Frame.decompress(Bytes.of(out.toByteArray), source.length, cut = false)
      assertEquals(read, Bytes.of(source), s"seed $seed")

  test("more than one block is written and read"):
    val source = draw(1, 1) ++ Array.tabulate(9 << 20)(at => (at * at >>> 9).toByte)
    val frame  = Lz4Frame.compress(source, 0, source.length)
    assertEquals(Lz4Frame.decompress(frame, source.length, cut = false), Bytes.of(source))
    val read = LZ4FrameInputStream(ByteArrayInputStream(frame.toArray)).readAllBytes()
    assert(java.util.Arrays.equals(read, source))

  test("of a part of an array, that part alone is compressed"):
    val source = draw(9, 4000)
    val half   = source.length / 2
    val frame  = Lz4Frame.compress(source, half, source.length)
    assertEquals(Lz4Frame.decompress(frame, source.length - half, cut = false), Bytes.of(source.drop(half)))

  test("blocks that look back into the one before are read, with checksums of blocks and content"):
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

  test("the checksum is xxHash's"):
    val other = XXHashFactory.fastestJavaInstance.hash32
    for seed <- 1L to 200 do
      val source = draw(seed, 100)
      assertEquals(
        XxHash32.of(source, 0, source.length),
        other.hash(source, 0, source.length, 0),
        s"seed $seed"
      )
