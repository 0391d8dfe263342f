package skein.mcap

import java.io.{File, IOException}
import java.nio.file.{Files, Path}
import scala.concurrent.duration.*
import scala.jdk.CollectionConverters.*
import scala.sys.process.{Process, ProcessLogger}
import skein.mcap.file.McapFile

/** The proof that others read what is written here, and the reverse: the official library of PyPI, unmodified, reads our
  * files and writes others. Runs where Python can install that library; it fetches it once per user.
  */
class OfficialPythonLibraryLiveSuite extends munit.FunSuite:
  override val munitTimeout: Duration = 5.minutes

  private val folder = FunFixture[Path](
    _ => Files.createTempDirectory("mcap"),
    folder => {
      Files.list(folder).forEach(Files.delete(_))
      Files.delete(folder)
    }
  )

  folder.test("the official library opens every file we write, and finds what we wrote"): folder =>
    val python  = library()
    val files   = (1L to 150).map(seed => s"any$seed" -> RandomFile.draw(seed, most = 100))
    val indexed =
      (1L to 150).map(seed =>
        s"indexed$seed" -> RandomFile.draw(seed, most = 200, options = RandomFile.indexed)
      )
    (files ++ indexed).foreach((name, file) => Files.write(folder.resolve(s"$name.mcap"), file.bytes.toArray))
    assertEquals(OfficialPythonLibrary.run(python, "read.py", folder), "READ 300 files")
    (files ++ indexed).foreach: (name, file) =>
      val others = file.attachments.map(Told.attachment) ++ file.metadata.map(Told.metadata)
      assertEquals(lines(folder, s"$name.stream.txt"), file.messages.map(told(file, _)) ++ others, file.show)
    indexed.foreach: (name, file) =>
      val ordered = file.asked(Query()).map(told(file, _))
      val others  = file.attachments.map(Told.attachment) ++ file.metadata.map(Told.metadata)
      val found   = lines(folder, s"$name.index.txt")
      assertEquals(found.dropRight(1), ordered ++ others, file.show)
      val ours = IndexedReader.open(ByteSource.of(file.bytes)).toOption.flatMap(_.summary.statistics).get
      assertEquals(
        found.last,
        s"statistics ${ours.messageCount} ${ours.chunkCount} ${ours.startTime} ${ours.endTime}",
        file.show
      )

  folder.test("we open every file that the official library writes, and find what it wrote"): folder =>
    val python = library()
    assertEquals(OfficialPythonLibrary.run(python, "write.py", folder), "WROTE 48 files")
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
      val index = McapFile.read(path): reader =>
        val messages =
          reader.messages(Query(order =
            Query.Order.File
          )).map(_.fold(error => fail(s"$path: $error"), Told.message))
        val attachments =
          reader.summary.attachments.map(reader.attachment(_).fold(
            error => fail(s"$path: $error"),
            Told.attachment
          ))
        val metadata =
          reader.summary.metadata.map(reader.metadata(_).fold(error => fail(s"$path: $error"), Told.metadata))
        messages.toVector ++ attachments ++ metadata
      assertEquals(index.fold(error => fail(s"$path: $error"), identity), written, s"$path")

  private def library(): Path =
    val python = OfficialPythonLibrary.install()
    assume(python.isRight, s"the official library cannot be installed here: ${python.swap.getOrElse("")}")
    python.toOption.get

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

/** What a file holds, a line for each thing, as `telling.py` tells it too. */
private object Told:
  private def hex(bytes: Bytes)   = if bytes.size == 0 then "-" else ConformanceGolden.hex(bytes)
  private def text(value: String) = hex(Bytes.utf8(value))
  private def time(value: Long)   = java.lang.Long.toUnsignedString(value)
  private def map(entries: Iterable[(String, String)]) =
    if entries.isEmpty then "-"
    else entries.map((key, value) => s"${text(key)}=${text(value)}").mkString(",")

  def message(found: TopicMessage): String =
    import found.channel
    val one    = found.message
    val schema =
      found.schema.fold("none")(named => s"${text(named.name)} ${text(named.encoding)} ${hex(named.data)}")
    s"message ${text(channel.topic)} ${text(channel.messageEncoding)} ${map(channel.metadata)} $schema " +
      s"${one.sequence} ${time(one.logTime)} ${time(one.publishTime)} ${hex(one.data)}"

  def attachment(one: Record.Attachment): String =
    s"attachment ${time(one.logTime)} ${time(one.createTime)} ${text(one.name)} ${text(one.mediaType)} ${hex(one.data)}"

  def metadata(one: Record.Metadata): String = s"metadata ${text(one.name)} ${map(one.metadata)}"

/** The official library in a virtual environment of its own, kept in the user's cache under the versions' names. */
private object OfficialPythonLibrary:
  private val packages  = Seq("mcap==1.6.0", "zstandard==0.25.0", "lz4==4.4.5")
  private val resources = Path.of(getClass.getResource("/mcap-python/read.py").toURI).getParent

  /** The environment's Python, or why there is none. */
  def install(): Either[String, Path] =
    val cache =
      Option(System.getenv("XDG_CACHE_HOME")).fold(Path.of(sys.props("user.home"), ".cache"))(Path.of(_))
    val home = cache.resolve("skein").resolve(packages.mkString("python-", "-", "").replace("==", "-"))
    val bin  = home.resolve("bin").resolve("python")
    if imports(bin) then Right(bin)
    else
      for
        _ <- ran("python3", "-m", "venv", "--clear", home.toString)
        _ <- ran(
          Seq(bin.toString, "-m", "pip", "install", "--quiet", "--disable-pip-version-check") ++ packages*
        )
        _ <- Either.cond(imports(bin), (), "it is installed but cannot be imported")
      yield bin

  /** What a script says last; of one that fails, everything. */
  def run(python: Path, script: String, folder: Path): String =
    ran(python.toString, "-u", resources.resolve(script).toString, folder.toString)
      .fold(identity, _.linesIterator.toSeq.lastOption.getOrElse(""))

  private def imports(python: Path): Boolean =
    Files.exists(python) && ran(python.toString, "-c", "import mcap.reader, zstandard, lz4.frame").isRight

  private def ran(command: String*): Either[String, String] =
    val output = StringBuilder()
    try
      val status = Process(command, Option.empty[File]).!(
        ProcessLogger(line => output.append(line).append('\n'): Unit)
      )
      Either.cond(
        status == 0,
        output.toString,
        s"${command.mkString(" ")}: ${output.toString.takeRight(2000)}"
      )
    catch case e: IOException => Left(e.getMessage)
