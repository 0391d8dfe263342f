package skein.cluster

import java.io.NotSerializableException
import org.apache.pekko.actor.ExtendedActorSystem
import org.apache.pekko.actor.typed.ActorRefResolver
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.serialization.SerializerWithStringManifest

/** Registers [[MessageCodec]] with Pekko, whose configuration names this class. */
final class MessageSerializer(system: ExtendedActorSystem) extends SerializerWithStringManifest:
  private lazy val codec =
    val refs = ActorRefResolver(system.toTyped)
    MessageCodec(refs.toSerializationFormat, refs.resolveActorRef(_))

  def identifier: Int = 0x736b31

  def manifest(message: AnyRef): String = "1"

  def toBinary(message: AnyRef): Array[Byte] = message match
    case ours: Message => codec.bytes(ours)
    case other => throw NotSerializableException(s"expected a message of the cluster, got ${other.getClass}")

  def fromBinary(bytes: Array[Byte], manifest: String): AnyRef =
    if manifest != "1" then
      throw NotSerializableException(s"expected messages of version 1, got '$manifest'")
    codec.message(bytes).fold(wrong => throw NotSerializableException(wrong), identity)
