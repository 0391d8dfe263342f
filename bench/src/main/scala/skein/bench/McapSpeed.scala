package skein.bench

import com.sun.management.OperatingSystemMXBean
import java.io.{BufferedOutputStream, DataOutputStream}
import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import java.nio.{ByteBuffer, ByteOrder}
import java.util.SplittableRandom
import java.util.zip.CRC32
import skein.mcap.*
import skein.mcap.file.McapFile

/** How fast are MCAP files written and read, compared with the official libraries? `bench/mcap` runs this and
  * their twins over common messages, which `corpus` writes to a separate file: for each message its log time,
  * ns, and its length as integers of 8 and 4 bytes, lowest first, then its data.
  *
  * A row states the operation, the compression, megabytes of messages per second of CPU time of the whole
  * process (so further threads do not make it faster), the size of the file, and as witness the CRC32 of all
  * data in the order read, which is equal in every row of a corpus. All CRCs are written, and checked while
  * reading.
  */
object McapSpeed:
  final private case class Message(logTime: Long, data: Array[Byte])

  def main(args: Array[String]): Unit = args.toList match
    case "corpus" :: kind :: path :: Nil        => corpus(kind, Path.of(path))
    case "run" :: rounds :: kind :: path :: Nil => run(rounds.toInt, kind, Path.of(path))
    case other => sys.error(s"expected corpus KIND PATH or run ROUNDS KIND PATH, got $other")

  /** `poses`: 1,000,000 messages of 96 bytes, times and doubles of a vehicle that circles in gusts. `images`:
    * 900 images of 256 × 144 × 3 bytes, a sky, a ground and 40 boxes that drift, with the noise of a sensor
    * in the lowest bit of a tenth of the bytes.
    */
  private def corpus(kind: String, path: Path): Unit =
    val random = SplittableRandom(7)
    val out    = DataOutputStream(BufferedOutputStream(Files.newOutputStream(path), 1 << 20))
    try
      kind match
        case "poses"  => (0 until 1_000_000).foreach(tick => put(out, tick * 1_000_000L, pose(tick, random)))
        case "images" => (0 until 900).foreach(tick => put(out, tick * 33_000_000L, image(tick, random)))
        case other    => sys.error(s"expected poses or images, got $other")
    finally out.close()

  private def put(out: DataOutputStream, time: Long, data: Array[Byte]): Unit =
    out.writeLong(java.lang.Long.reverseBytes(time))
    out.writeInt(Integer.reverseBytes(data.length))
    out.write(data)

  private def pose(tick: Int, random: SplittableRandom): Array[Byte] =
    val bytes = ByteBuffer.allocate(96).order(ByteOrder.LITTLE_ENDIAN)
    val phase = tick * 1e-4
    bytes.putLong(tick * 1_000_000L)
    Vector(math.cos(phase) * 20, math.sin(phase) * 20, -10.0).foreach(at =>
      bytes.putDouble(at + random.nextDouble() * 1e-3)
    )
    Vector(-math.sin(phase) * 2, math.cos(phase) * 2, 0.0).foreach(at =>
      bytes.putDouble(math.rint(at * 1e6) * 1e-6)
    )
    Vector(1.0, 0.0, 0.0, phase).foreach(at => bytes.putDouble(math.rint(at * 1e6) * 1e-6))
    bytes.array

  private def image(tick: Int, random: SplittableRandom): Array[Byte] =
    val (width, height) = (256, 144)
    val pixels          = new Array[Byte](width * height * 3)
    def fill(left: Int, top: Int, right: Int, bottom: Int, colour: Int): Unit =
      for y <- top.max(0) until bottom.min(height); x <- left.max(0) until right.min(width); c <- 0 until 3 do
        pixels((y * width + x) * 3 + c) = (colour >> 8 * c).toByte
    fill(0, 0, width, height / 2, 0xd0b090)
    fill(0, height / 2, width, height, 0x507040)
    for box <- 0 until 40 do
      val left = (box * 37 + tick * (1 + box % 5)) % (width + 40) - 40
      val top  = 30 + box * 53                     % 90
      fill(left, top, left + 10 + box % 30, top + 8 + box % 20, box * 0x1f3d59)
    for at <- pixels.indices do if random.nextInt(10) == 0 then pixels(at) = (pixels(at) ^ 1).toByte
    pixels

  private def load(path: Path): Vector[Message] =
    val bytes = ByteBuffer.wrap(Files.readAllBytes(path)).order(ByteOrder.LITTLE_ENDIAN)
    val found = Vector.newBuilder[Message]
    while bytes.hasRemaining do
      val time = bytes.getLong()
      val data = new Array[Byte](bytes.getInt())
      bytes.get(data)
      found += Message(time, data)
    found.result()

  private val process = ManagementFactory.getPlatformMXBean(classOf[OperatingSystemMXBean])

  private def run(rounds: Int, kind: String, path: Path): Unit =
    val messages  = load(path)
    val megabytes = messages.map(_.data.length.toLong).sum / 1e6
    val file      = Files.createTempFile(path.toAbsolutePath.getParent, "speed", ".mcap")
    val ways      = Vector(
      "none"   -> Compression.Uncompressed,
      "lz4"    -> Compression.Lz4,
      "zstd 1" -> Compression.Zstd(1),
      "zstd 3" -> Compression.Zstd(3)
    )
    try
      for (name, compression) <- ways do
        // The first rounds warm up the compiler.
        val times = Vector.fill(rounds + 3)(round(file, messages, compression)).drop(3)
        val sums  = times.map(_._3).toSet
        require(sums.size == 1, s"every round reads the same, got $sums")
        row("skein write", kind, name, megabytes / times.map(_._1).min, Files.size(file), sums.head)
        row("skein read", kind, name, megabytes / times.map(_._2).min, Files.size(file), sums.head)
    finally Files.delete(file)

  private def row(what: String, kind: String, name: String, rate: Double, size: Long, sum: Long): Unit =
    println(f"| $what | $kind | $name | $rate%.0f | ${size / 1e6}%.1f | $sum%08x |")

  /** CPU seconds for writing and for reading, and the witness. */
  private def round(file: Path, messages: Vector[Message], compression: Compression): (Double, Double, Long) =
    val begin = process.getProcessCpuTime
    McapFile.write(file, WriterOptions(compression = compression)): mcap =>
      val channel = mcap.channel("/speed", "raw")
      var at      = 0
      messages.foreach: message =>
        mcap.message(channel, at, message.logTime, message.logTime, Bytes.of(message.data))
        at += 1
    val written = process.getProcessCpuTime
    val sum     = CRC32()
    var count   = 0
    McapFile.stream(file): records =>
      records.foreach:
        case Right(Parsed.Found(message: Record.Message, _, _)) =>
          sum.update(message.data.buffer)
          count += 1
        case Right(_)    => ()
        case Left(error) => sys.error(error.message)
    val read = process.getProcessCpuTime
    require(count == messages.size, s"$count of ${messages.size} messages")
    ((written - begin) / 1e9, (read - written) / 1e9, sum.getValue)
