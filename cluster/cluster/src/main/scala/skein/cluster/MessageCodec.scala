package skein.cluster

import org.apache.pekko.actor.typed.ActorRef
import scala.collection.immutable.ArraySeq
import skein.bytes.Codec

/** Encodes messages with [[Codec]]. Every size that a peer states is checked against its bound before use.
  *
  * @param nameOf writes an actor's address as text, which `actorOf` reads
  */
private[cluster] final class MessageCodec(
    nameOf: ActorRef[ToWorker] => String,
    actorOf: String => ActorRef[ToWorker]
):
  import MessageCodec.*

  private given Codec[String] =
    Codec.blob(MostText).imap(String(_, "UTF-8"))(_.take(MostText / 4).getBytes("UTF-8"))

  private given Codec[ArraySeq[Byte]] = Codec.blob(MostBytes).imap(ArraySeq.unsafeWrapArray)(_.toArray)

  private given Codec[Set[Long]] = Codec.of[Set[Long]]((held, out) =>
    out.writeInt(held.size)
    held.foreach(out.writeLong)
  )(in => Set.from(Iterator.fill(Codec.length(in, MostHeld))(in.readLong())))

  private given Codec[ActorRef[ToWorker]] = Codec[String].imap(actorOf)(nameOf)

  private given Codec[Message] = Codec.derived

  def bytes(message: Message): Array[Byte] = Codec.bytes(message)

  /** @return Left with one line that says what was expected and what was read */
  def message(bytes: Array[Byte]): Either[String, Message] =
    try
      Codec.message[Message](bytes).flatMap:
        case Message.Ask(_, cores, _, _, _, _) if cores < 1 || cores > MostCores =>
          Left(s"expected 1 to $MostCores cores, got $cores")
        case read => Right(read)
    catch case wrong: IllegalArgumentException => Left(s"expected an actor's address: ${wrong.getMessage}")

private[cluster] object MessageCodec:
  val MostText  = 4096
  val MostBytes = 640 << 10
  val MostCores = 1024
  val MostHeld  = 2 * MostCores
