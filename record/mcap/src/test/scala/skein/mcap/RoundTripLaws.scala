package skein.mcap

import java.util.SplittableRandom

/** What is written is read, in every way of reading. */
class RoundTripLaws extends munit.FunSuite:

  test("a stream gives every message, attachment and metadata record as it was written"):
    for seed <- 1L to 400 do
      val file = RandomFile.draw(seed)
      val read = Parsing.all(file.bytes, piece = 1 + (seed * 37 % 500).toInt)
      assertEquals(read.end, Parsed.Ended, file.show)
      assertEquals(read.messages, file.messages, file.show)
      assertEquals(attachments(read.records), file.attachments, file.show)
      assertEquals(read.records.collect { case record: Record.Metadata => record }, file.metadata, file.show)

  test("by index, every query finds what it asks for, in its order"):
    for seed <- 1L to 400 do
      val file   = RandomFile.draw(seed, most = 120)
      val random = SplittableRandom(-seed)
      val reader = open(file)
      for _ <- 0 until 6 do
        val query = draw(random, file)
        val found =
          reader.messages(query).map(_.fold(error => fail(s"${file.show}: $error"), identity)).toVector
        assertEquals(found.map(_.message), file.asked(query), s"${file.show}, $query")
        found.foreach: one =>
          assertEquals(one.channel, file.channels(one.message.channelId), file.show)
          assertEquals(one.schema, file.schemas.get(one.channel.schemaId), file.show)

  test("by index, every attachment and metadata record is found"):
    for seed <- 1L to 200 do
      val file   = RandomFile.draw(seed, options = RandomFile.indexed)
      val reader = open(file)
      assertEquals(
        attachments(reader.summary.attachments.map(reader.attachment(_).fold(fail(_), identity))),
        file.attachments,
        file.show
      )
      assertEquals(
        reader.summary.metadata.map(reader.metadata(_).fold(fail(_), identity)),
        file.metadata,
        file.show
      )

  test("a file with all indexes is not read through, and one without is"):
    for seed <- 1L to 200 do
      val whole = RandomFile.draw(seed, options = RandomFile.indexed)
      assert(!open(whole).summary.rebuilt, whole.show)
      val plain = RandomFile.draw(seed, options = _ => WriterOptions(chunkIndex = false))
      assertEquals(open(plain).summary.rebuilt, (plain.schemas.size + plain.channels.size) > 0, plain.show)

  test("what a file says of itself is what reading it through finds"):
    for seed <- 1L to 200 do
      val file    = RandomFile.draw(seed, options = RandomFile.indexed)
      val told    = open(file).summary
      val cut     = file.bytes.slice(0, file.bytes.size - 1)
      val rebuilt = IndexedReader.open(ByteSource.of(cut)).fold(fail(_), identity).summary
      assert(rebuilt.rebuilt, file.show)
      assertEquals(rebuilt.statistics, told.statistics, file.show)
      assertEquals(rebuilt.attachments, told.attachments, file.show)
      assertEquals(rebuilt.metadata, told.metadata, file.show)
      assertEquals(rebuilt.channels, told.channels, file.show)
      assertEquals(rebuilt.stretches, told.stretches.filter(_.channels.nonEmpty), file.show)

  private def attachments(records: Vector[Record]) = records.collect:
    case record: Record.Attachment => record.copy(crc = 0)

  private def fail(error: McapError): Nothing = fail(error.message)

  private def open(file: RandomFile) =
    IndexedReader.open(ByteSource.of(file.bytes)).fold(error => fail(s"${file.show}: $error"), identity)

  private def draw(random: SplittableRandom, file: RandomFile) =
    val times  = file.messages.map(_.logTime) :+ 0L
    def time() = times(random.nextInt(times.size)) + random.nextInt(2)
    Query(
      if random.nextInt(2) == 0 then 0 else time(),
      Option.when(random.nextInt(2) == 0)(time()),
      Option.when(random.nextInt(2) == 0)(Set("/0", s"/${random.nextInt(5)}")),
      Query.Order.fromOrdinal(random.nextInt(3))
    )
