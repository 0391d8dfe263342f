package skein.airsim.wire

import java.nio.charset.StandardCharsets.UTF_8
import upickle.default.{Reader, SimpleReader}

/** A string received as MessagePack str or bin; old clients send the latter. */
final private[skein] case class Text(value: String)

private[skein] object Text:
  given Reader[Text] = new SimpleReader[Text]:
    def expectedMsg                                             = "expected a string"
    override def visitString(s: CharSequence, index: Int): Text = Text(s.toString)
    override def visitBinary(bytes: Array[Byte], offset: Int, length: Int, index: Int): Text =
      Text(String(bytes, offset, length, UTF_8))
