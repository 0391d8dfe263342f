package skein.rpc

import org.apache.pekko.util.ByteString

/** A value that is already encoded as MessagePack and is sent unchanged: a large value needs neither a tree
  * nor a copy.
  *
  * @param bytes the encoding of exactly one value; its pieces must not change afterwards
  */
final case class Encoded(bytes: ByteString)
