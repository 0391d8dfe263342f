package skein.environment

import java.io.{DataInputStream, DataOutputStream, EOFException, IOException}
import java.net.{StandardProtocolFamily, UnixDomainSocketAddress}
import java.nio.channels.{Channels, ClosedChannelException, FileChannel, ServerSocketChannel, SocketChannel}
import java.nio.file.{Files, Path, StandardOpenOption}
import java.nio.file.attribute.PosixFilePermissions
import scala.jdk.CollectionConverters.*
import scala.util.Try
import scala.util.control.NonFatal
import skein.scenario.Scenarios
import skein.units.Expect

/** Environments behind a Unix socket, for processes that fork, or that cannot contain a JVM. Observations and
  * actions are in a file that both sides map ([[EnvironmentBuffers]]); the socket carries only requests.
  *
  * A connection is one batch. It begins with a text of `name=value` lines: `count`, `autoreset` (0 next step,
  * 1 same step, 2 disabled), `file`, and the settings. A text without a `file` is answered by the learners'
  * names, one line each, and another follows. Each request then begins with a byte: 1 for a step; 2 for a
  * reset, followed by a seed (64 bits) for each environment; 3 for a reset of some, followed by the seeds and
  * by a byte for each environment; 4 for a description of their engine. Every answer, also that to a text,
  * begins with a byte: 0 done, followed by a text if the request was a 4 or a text without a `file`; 1 wrong
  * arguments or 2 wrong state, followed by a text. A text is its length in bytes (32 bits) and UTF-8. Numbers
  * are big-endian.
  *
  * The server ends with its standard input: when the process that started it ends.
  */
object EnvironmentServer:
  private val MostText = 1 << 16
  private val RetryMs  = 100

  def main(arguments: Array[String]): Unit = arguments match
    case Array(path) =>
      val server = ServerSocketChannel.open(StandardProtocolFamily.UNIX)
      server.bind(UnixDomainSocketAddress.of(path)): Unit
      Files.setPosixFilePermissions(Path.of(path), PosixFilePermissions.fromString("rw-------")): Unit
      daemon: () =>
        while server.isOpen do
          try accept(server)
          catch
            case _: ClosedChannelException => ()
            case failure: IOException      => // Too many open files, for example: later there may be fewer.
              Console.err.println(s"environments: no connection could be accepted: ${failure.getMessage}")
              Thread.sleep(RetryMs)
      println("ready")
      while System.in.read() >= 0 do ()
      server.close()
      val _ = Files.deleteIfExists(Path.of(path))
    case _ =>
      Console.err.println("expected the path of a socket")
      sys.exit(2)

  private def accept(server: ServerSocketChannel): Unit =
    val client = server.accept()
    daemon: () =>
      try serve(client)
      catch case _: IOException => () // The client has gone.
      finally client.close()

  private def daemon(body: () => Unit): Unit =
    val thread = Thread(() => body())
    thread.setDaemon(true)
    thread.start()

  private def serve(client: SocketChannel): Unit =
    val in    = DataInputStream(Channels.newInputStream(client))
    val out   = DataOutputStream(Channels.newOutputStream(client))
    var words = wordsOf(text(in))
    var known = Map.empty[Map[String, String], EnvironmentBatch.Prepared]
    while !words.contains("file") do
      prepared(words) match
        case Left(mistake) => answer(out, 1, mistake)
        case Right(made)   =>
          known = Map(words -> made)
          answer(out, 0, made.learners)
      words = wordsOf(text(in))
    opened(words, settings => known.get(settings).fold(prepared(settings))(Right(_))) match
      case Left(mistake) => answer(out, 1, mistake)
      case Right(batch)  =>
        out.write(0)
        try stepped(batch, in, out)
        finally batch.close()

  private def stepped(batch: EnvironmentBatch, in: DataInputStream, out: DataOutputStream): Unit =
    var going = true
    while going do
      val request = in.read()
      if request < 0 then going = false
      else
        try
          request match
            case 1 => batch.step()
            case 2 => batch.reset(seeds(in, batch.count))
            case 3 => batch.reset(seeds(in, batch.count), in.readNBytes(batch.count).map(_ != 0))
            case 4 => ()
            case _ => throw EOFException(s"expected 1 to 4, got $request")
          if request == 4 then answer(out, 0, batch.engine.text) else out.write(0)
        catch
          case mistake: IllegalArgumentException => answer(out, 1, Expect.refused(mistake))
          case mistake: IOException              => throw mistake
          case NonFatal(mistake)                 => answer(out, 2, mistake.getMessage)

  private def wordsOf(text: String): Map[String, String] =
    text.linesIterator.map(_.split("=", 2)).collect { case Array(name, value) => name -> value }.toMap

  private def prepared(settings: Map[String, String]) =
    EnvironmentSettings.read(settings.asJava).flatMap(EnvironmentBatch.prepared(_)(using Scenarios.ours))

  /** @param resolved the settings, of which those of the text before are known */
  private def opened(
      told: Map[String, String],
      resolved: Map[String, String] => Either[String, EnvironmentBatch.Prepared]
  ): Either[String, EnvironmentBatch] =
    for
      count     <- told.get("count").flatMap(_.toIntOption).toRight("count: expected a whole number")
      autoreset <- told
        .get("autoreset")
        .flatMap(_.toIntOption)
        .filter(Autoreset.values.indices.contains)
        .toRight("autoreset: expected 0, 1 or 2")
      file  <- told.get("file").toRight("file: expected the path of a file")
      made  <- resolved(told - "count" - "autoreset" - "file")
      block <- Try:
        val channel = FileChannel.open(Path.of(file), StandardOpenOption.READ, StandardOpenOption.WRITE)
        try channel.map(FileChannel.MapMode.READ_WRITE, 0, channel.size)
        finally channel.close()
      .toEither.left.map(reason => s"file: expected one to read and write, got $reason")
      batch <- made.batch(count, Autoreset.fromOrdinal(autoreset), block)
    yield batch

  private def seeds(in: DataInputStream, count: Int) = Array.fill(count)(in.readLong())

  private def text(in: DataInputStream): String =
    val length = in.readInt()
    if length < 0 || length > MostText then
      throw IOException(s"expected at most $MostText bytes, got $length")
    String(in.readNBytes(length), "UTF-8")

  private def answer(out: DataOutputStream, status: Int, message: String): Unit =
    val bytes = message.getBytes("UTF-8")
    out.write(status)
    out.writeInt(bytes.length)
    out.write(bytes)
