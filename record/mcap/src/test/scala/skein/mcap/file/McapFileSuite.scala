package skein.mcap.file

import java.nio.channels.Channels
import java.nio.file.{Files, Path}
import skein.mcap.*
import skein.testing.TemporaryFolders

class McapFileSuite extends munit.FunSuite, TemporaryFolders:
  private val folder =
    FunFixture[Path](
      _ => temporaryFolder(),
      folder => {
        Files.list(folder).forEach(Files.delete(_))
        Files.delete(folder)
      }
    )

  folder.test("the code in docs/mcap.md writes and reads a file"): folder =>
    val path = folder.resolve("flight.mcap")
    // begin
    McapFile.write(path): mcap =>
      val schema  = mcap.schema("Height", "jsonschema", Bytes.utf8("""{"type": "object"}"""))
      val heights = mcap.channel("/drone/height", "json", schema)
      for tick <- 0 until 1000 do
        val atNs = tick * 50_000_000L
        mcap.message(heights, tick, atNs, atNs, Bytes.utf8(s"""{"heightM": ${tick * 0.01}}"""))
      mcap.attachment(0, 0, "settings.conf", "text/plain", Bytes.utf8("loop = stream"))

    val found = McapFile.read(path, _.message.logTime >= 2_000_000_000L): messages =>
      messages.map(_.map(_.message.data.utf8)).toVector
    // end
    val heights = found.map(_.fold(error => fail(error.message), identity))
    assertEquals(heights.size, 960)
    assertEquals(heights.head, """{"heightM": 0.4}""")

    val source = Iterator.iterate(
      Path.of("").toAbsolutePath
    )(_.getParent).map(_.resolve("docs/mcap.md")).find(Files.exists(_))
    val shown = Files.readString(source.get)
    val own   = Files.readString(
      source.get.resolveSibling("../record/mcap/src/test/scala/skein/mcap/file/McapFileSuite.scala")
    )
    val example =
      own.split("    // begin\n")(1).split("    // end\n")(0).linesIterator.map(_.drop(4)).mkString("\n")
    assert(shown.contains(example), "docs/mcap.md shows other lines")

  folder.test("a file whose writer failed is read up to its last chunk"): folder =>
    val path = folder.resolve("failed.mcap")
    intercept[IllegalStateException]:
      McapFile.write(path): mcap =>
        val channel = mcap.channel("/a", "")
        mcap.message(channel, 0, 1, 1, Bytes.empty)
        mcap.flush()
        mcap.message(channel, 1, 2, 2, Bytes.empty)
        throw IllegalStateException("the writer fails")
    val found = McapFile.read(path)(_.map(_.left.map(_.getClass)).toVector)
    assertEquals(found.size, 2)
    assert(found.head.isRight && found.last == Left(classOf[McapError.CutOff]), s"$found")

  folder.test("a stream reads from a source that can be read once"): folder =>
    val path = folder.resolve("once.mcap")
    McapFile.write(path)(mcap => mcap.message(mcap.channel("/a", ""), 7, 1, 1, Bytes.utf8("x")))
    val stream   = RecordStream(Channels.newChannel(Files.newInputStream(path)))
    val messages = stream.collect { case Right(Parsed.Found(message: Record.Message, _, _)) =>
      (stream.channel(message.channelId).map(_.topic), message.sequence)
    }
    assertEquals(messages.toVector, Vector((Some("/a"), 7)))

  folder.test("a stream ends with the reason why it cannot continue"): folder =>
    val path = folder.resolve("cut.mcap")
    McapFile.write(path)(mcap => mcap.message(mcap.channel("/a", ""), 7, 1, 1, Bytes.utf8("x")))
    Files.write(path, Files.readAllBytes(path).dropRight(3))
    McapFile.stream(path)(_.toVector.last) match
      case Left(McapError.CutOff(_, _, 5)) => ()
      case other                           => fail(s"$other")

  folder.test("a newer file replaces a longer older one completely"): folder =>
    val path = folder.resolve("twice.mcap")
    Files.write(path, new Array[Byte](5000))
    McapFile.write(path)(_ => ())
    assertEquals(McapFile.stream(path)(_.filter(_.isLeft).toVector), Vector.empty)
