package skein.observe

import java.io.{IOException, InputStream}
import java.nio.charset.StandardCharsets.UTF_8
import java.util.concurrent.{CompletableFuture, TimeUnit, TimeoutException}
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import scala.jdk.StreamConverters.*
import skein.units.Span

/** A program started by this process, without input. The last parts of its outputs are kept. */
final class OutsideProgram private (process: Process, out: OutsideProgram.Tail, err: OutsideProgram.Tail):
  import OutsideProgram.*

  def exit: Option[Int] = Option.when(!process.isAlive)(process.exitValue)

  def await(most: Span): Unit = process.waitFor(most.toNanos.max(0), TimeUnit.NANOSECONDS): Unit

  /** The last non-blank line of its standard output. Complete after [[stop]]. */
  def lastLine: Option[String] = out.lastLine

  def lastError: Option[String] = err.lastLine

  /** The last parts of its standard output and standard error, at most 64 KiB of each. */
  def printed: String = Seq(out.text, err.text).filter(_.nonEmpty).mkString("\n")

  /** Ends the program, if it still runs, with all processes that it started, and waits for the rest of their
    * output.
    */
  def stop(): Unit =
    OutsideProgram.stop(process)
    Seq(out, err).foreach(_.await(RestMillis))

object OutsideProgram:
  private val KeptBytes  = 64 << 10
  private val GraceS     = 5L
  private val RestMillis = 1_000L

  /** @return Left says in a line why it cannot be started */
  def start(command: Seq[String], environment: Map[String, String]): Either[String, OutsideProgram] =
    try
      val builder = ProcessBuilder(command*)
      builder.environment.putAll(environment.asJava)
      val process = builder.start()
      process.getOutputStream.close()
      Right(OutsideProgram(process, Tail(process.getInputStream), Tail(process.getErrorStream)))
    catch case absent: IOException => Left(s"cannot start ${command.head}: ${absent.getMessage}")

  /** Requests a process and all that it started to end, and kills those that still run 5 s later. */
  def stop(process: Process): Unit =
    val all = process.descendants().toScala(Vector) :+ process.toHandle
    all.foreach(_.destroy(): Unit)
    val ended = CompletableFuture.allOf(all.map(_.onExit())*)
    try ended.get(GraceS, TimeUnit.SECONDS): Unit
    catch
      case _: TimeoutException =>
        all.foreach(_.destroyForcibly(): Unit)
        ended.get(): Unit

  /** Reads a stream to its end and keeps the last [[KeptBytes]]. */
  private final class Tail(stream: InputStream):
    private val kept = mutable.ArrayDeque.empty[Byte]

    private val reading = Thread.ofVirtual().start: () =>
      val piece = Array.ofDim[Byte](8 << 10)
      try Iterator.continually(stream.read(piece)).takeWhile(_ >= 0).foreach(keep(piece, _))
      catch case _: IOException => () // its end closed the pipe

    private def keep(piece: Array[Byte], size: Int): Unit = synchronized:
      kept ++= piece.take(size)
      kept.takeRightInPlace(KeptBytes): Unit

    def await(millis: Long): Unit = reading.join(millis)

    def text: String = synchronized(String(kept.toArray, UTF_8))

    def lastLine: Option[String] = text.linesIterator.map(_.trim).filter(_.nonEmpty).toSeq.lastOption
