package skein.rpc

import org.apache.pekko.util.ByteString

/** A value that is MessagePack already, sent as it is: of a large one, neither a tree nor a copy is made.
  *
  * @param bytes of exactly one value; its pieces must not change afterwards
  */
final case class Encoded(bytes: ByteString)
