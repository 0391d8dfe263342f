package skein.mcap

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.mcap.file.McapFile
import skein.testing.{Lengthy, PythonEnvironment, TemporaryFolders, Waiting}

/** Proof of compatibility in both directions: the official library of PyPI, unmodified, reads our files and
  * writes others. Runs if Python can install that library; it fetches it once per user.
  */
class OfficialPythonLibraryLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Waiting:
  folder.test("the official library opens every file we write, and reads its content"): folder =>
    val files   = (1L to 30).map(seed => s"any$seed" -> RandomFile.draw(seed, most = 100))
    val indexed =
      (1L to 30).map(seed =>
        s"indexed$seed" -> RandomFile.draw(seed, most = 200, options = RandomFile.indexed)
      )
    (files ++ indexed).foreach((name, file) => Files.write(folder.resolve(s"$name.mcap"), file.bytes.toArray))
    assertEquals(OfficialPythonLibrary.run("read.py", folder.toString), (0, "READ 60 files\n"))
    (files ++ indexed).foreach: (name, file) =>
      val others = file.attachments.map(Told.attachment) ++ file.metadata.map(Told.metadata)
      assertEquals(lines(folder, s"$name.stream.txt"), file.messages.map(told(file, _)) ++ others, file.show)
    indexed.foreach: (name, file) =>
      val ordered = file.byTime.map(told(file, _))
      val others  = file.attachments.map(Told.attachment) ++ file.metadata.map(Told.metadata)
      val found   = lines(folder, s"$name.index.txt")
      assertEquals(found.dropRight(1), ordered ++ others, file.show)
      val ours = Parsing.all(file.bytes).records.collectFirst { case counts: Record.Statistics => counts }.get
      assertEquals(
        found.last,
        s"statistics ${ours.messageCount} ${ours.chunkCount} ${ours.startTime} ${ours.endTime}",
        file.show
      )

  folder.test("we open every file that the official library writes, and read its content"): folder =>
    assertEquals(OfficialPythonLibrary.run("write.py", folder.toString), (0, "WROTE 48 files\n"))
    val paths = Files.list(folder).iterator.asScala.filter(_.toString.endsWith(".mcap")).toVector
    paths.foreach: path =>
      val written = lines(folder, path.getFileName.toString.replace(".mcap", ".txt"))
      val stream  = McapFile.stream(path): records =>
        val all = records.map(_.fold(error => fail(s"$path: ${error.message}"), _.record)).map(tell(
          records,
          _
        )).toVector
        Vector("message", "attachment", "metadata").flatMap(kind => all.filter(_.startsWith(s"$kind ")))
      assertEquals(stream, written, s"$path")

  private def lines(folder: Path, name: String) = Files.readAllLines(folder.resolve(name)).asScala.toVector

  private def told(file: RandomFile, message: Record.Message) =
    val channel = file.channels(message.channelId)
    Told.message(TopicMessage(channel, file.schemas.get(channel.schemaId), message))

  private def tell(records: file.RecordStream, record: Record): String = record match
    case message: Record.Message =>
      val channel = records.channel(message.channelId).get
      Told.message(TopicMessage(channel, records.schema(channel.schemaId), message))
    case attachment: Record.Attachment => Told.attachment(attachment)
    case metadata: Record.Metadata     => Told.metadata(metadata)
    case _                             => "other"

val OfficialPythonLibrary = PythonEnvironment(
  "mcap.reader, zstandard, lz4.frame",
  Some("/mcap-python/read.py"),
  Seq("mcap==1.6.0", "zstandard==0.25.0", "lz4==4.4.5")
)
