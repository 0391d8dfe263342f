package skein.cluster

import java.io.{ByteArrayInputStream, ByteArrayOutputStream, DataInputStream, DataOutputStream, IOException}
import org.apache.pekko.actor.typed.ActorRef
import scala.collection.immutable.ArraySeq
import skein.cluster.jars.Sha256

/** Messages as bytes: a byte for the kind, then the fields in their order, big-endian; texts and byte strings
  * behind their length, 4 bytes. No size that a peer states is believed before it is seen to be within its
  * bound.
  *
  * @param nameOf an actor's address as text, and back
  */
private[cluster] final class MessageCodec(
    nameOf: ActorRef[ToWorker] => String,
    actorOf: String => ActorRef[ToWorker]
):
  import MessageCodec.*

  def bytes(message: ToCoordinator | ToWorker): Array[Byte] =
    val out                 = ByteArrayOutputStream()
    val data                = DataOutputStream(out)
    def text(value: String) =
      val encoded = value.take(MostText / 4).getBytes("UTF-8")
      data.writeInt(encoded.length)
      data.write(encoded)
    def blob(value: ArraySeq[Byte]) =
      require(value.length <= MostBytes, s"a message's part has ${value.length} bytes, at most $MostBytes go")
      data.writeInt(value.length)
      data.write(value.toArray)
    message match
      case ToCoordinator.Ask(worker, cores, build, run, holding, replyTo) =>
        data.writeByte(1)
        text(worker)
        data.writeInt(cores)
        text(build)
        data.writeLong(run)
        data.writeInt(holding.size)
        holding.foreach(data.writeLong)
        text(nameOf(replyTo))
      case ToCoordinator.Done(run, worker, number, busyNanos, answer) =>
        data.writeByte(2)
        data.writeLong(run)
        text(worker)
        data.writeLong(number)
        data.writeLong(busyNanos)
        blob(answer)
      case ToCoordinator.Failed(run, worker, number, reason) =>
        data.writeByte(3)
        data.writeLong(run)
        text(worker)
        data.writeLong(number)
        text(reason)
      case ToCoordinator.Unable(run, worker, reason) =>
        data.writeByte(4)
        data.writeLong(run)
        text(worker)
        text(reason)
      case ToWorker.Welcome(run, question) =>
        data.writeByte(5)
        data.writeLong(run)
        blob(question)
      case ToWorker.Give(run, number, work) =>
        data.writeByte(6)
        data.writeLong(run)
        data.writeLong(number)
        blob(work)
      case ToWorker.Refused(reason) =>
        data.writeByte(7)
        text(reason)
      case ToWorker.Goodbye                       => data.writeByte(8)
      case ToWorker.Offered(run, reason, program) =>
        data.writeByte(9)
        data.writeLong(run)
        text(reason)
        text(program.hex)
      case ToWorker.Piece(content, offset, bytes) =>
        data.writeByte(10)
        text(content.hex)
        data.writeLong(offset)
        blob(bytes)
      case ToCoordinator.Fetch(worker, content, offset, replyTo) =>
        data.writeByte(11)
        text(worker)
        text(content.hex)
        data.writeLong(offset)
        text(nameOf(replyTo))
    out.toByteArray

  /** @return or what was expected, and what came */
  def message(bytes: Array[Byte]): Either[String, ToCoordinator | ToWorker] =
    val in                    = DataInputStream(ByteArrayInputStream(bytes))
    def count(most: Int): Int =
      val came = in.readInt()
      if came < 0 || came > most then throw IOException(s"expected a length of 0 to $most, came $came")
      came
    def part(most: Int) =
      val length = count(most)
      if length > in.available then
        throw IOException(s"expected $length more bytes, came ${in.available}")
      in.readNBytes(length)
    def text()                 = String(part(MostText), "UTF-8")
    def blob(): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(part(MostBytes))
    def sha256()               = Sha256.parse(text()).fold(wrong => throw IOException(wrong), identity)
    try
      val read: ToCoordinator | ToWorker = in.readByte().toInt match
        case 1 =>
          val worker = text()
          val cores  = in.readInt()
          if cores < 1 || cores > MostCores then
            throw IOException(s"expected 1 to $MostCores cores, came $cores")
          val build   = text()
          val run     = in.readLong()
          val holding = Set.from(Iterator.fill(count(MostHeld))(in.readLong()))
          ToCoordinator.Ask(worker, cores, build, run, holding, actorOf(text()))
        case 2     => ToCoordinator.Done(in.readLong(), text(), in.readLong(), in.readLong(), blob())
        case 3     => ToCoordinator.Failed(in.readLong(), text(), in.readLong(), text())
        case 4     => ToCoordinator.Unable(in.readLong(), text(), text())
        case 5     => ToWorker.Welcome(in.readLong(), blob())
        case 6     => ToWorker.Give(in.readLong(), in.readLong(), blob())
        case 7     => ToWorker.Refused(text())
        case 8     => ToWorker.Goodbye
        case 9     => ToWorker.Offered(in.readLong(), text(), sha256())
        case 10    => ToWorker.Piece(sha256(), in.readLong(), blob())
        case 11    => ToCoordinator.Fetch(text(), sha256(), in.readLong(), actorOf(text()))
        case other => throw IOException(s"expected a kind of message from 1 to 11, came $other")
      Either.cond(in.available == 0, read, s"expected the message's end, came ${in.available} more bytes")
    catch
      case _: java.io.EOFException         => Left(s"the message is cut off after ${bytes.length} bytes")
      case wrong: IOException              => Left(wrong.getMessage)
      case wrong: IllegalArgumentException => Left(s"expected an actor's address: ${wrong.getMessage}")

private[cluster] object MessageCodec:
  val MostText  = 4096
  val MostBytes = 640 << 10
  val MostCores = 1024
  val MostHeld  = 2 * MostCores
