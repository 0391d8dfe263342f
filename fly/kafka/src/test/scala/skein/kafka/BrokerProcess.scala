package skein.kafka

import java.io.File
import java.nio.file.Path
import java.util.concurrent.TimeUnit
import scala.jdk.CollectionConverters.*
import skein.link.Address

/** A broker in a separate process, on loopback, which can be killed. It ends with the process that started
  * it.
  */
final class BrokerProcess private (process: Process, val address: Address):

  /** Kills the process as by `kill -9`: it writes nothing more, and notifies no client. */
  def kill(): Unit =
    if !process.destroyForcibly().waitFor(60, TimeUnit.SECONDS) then
      throw IllegalStateException("it lives on")

object BrokerProcess:
  private val Started = """broker at port (\d+)""".r

  /** Blocks until it answers.
    *
    * @param folder holds the broker's data; data of an earlier broker is continued
    * @param port 0 for any free one
    */
  def start(folder: Path, port: Int, log: File): BrokerProcess =
    val java    = Path.of(sys.props("java.home"), "bin", "java").toString
    val command = Seq(java, "-Xmx256m", "-XX:+UseSerialGC", "-XX:TieredStopAtLevel=1") ++
      Seq("-cp", sys.props("java.class.path"), "skein.kafka.broker", folder.toString, port.toString)
    val process = ProcessBuilder(command*).redirectError(log).start()
    process.inputReader.lines.iterator.asScala.collectFirst { case Started(port) => port.toInt } match
      case Some(port) => BrokerProcess(process, Address("127.0.0.1", port))
      case None       => throw IllegalStateException(s"the broker did not start; it said in $log why")

@main def broker(folder: String, port: Int): Unit =
  val started = KafkaBroker.start(Path.of(folder), Address("127.0.0.1", port))
  val own     = started.fold(reason => throw IllegalStateException(reason), identity)
  println(s"broker at port ${own.address.port}")
  while System.in.read() >= 0 do ()
  Runtime.getRuntime.halt(0)
