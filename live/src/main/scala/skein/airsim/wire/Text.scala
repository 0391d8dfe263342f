package skein.airsim.wire

import java.nio.charset.StandardCharsets.UTF_8
import upickle.default.{Reader, SimpleReader}

/** A string that may have come as MessagePack str or bin: old clients send the latter. */
final private[airsim] case class Text(value: String)

private[airsim] object Text:
  given Reader[Text] = new SimpleReader[Text]:
    def expectedMsg                                             = "expected a string"
    override def visitString(s: CharSequence, index: Int): Text = Text(s.toString)
    override def visitBinary(bytes: Array[Byte], offset: Int, length: Int, index: Int): Text =
      Text(String(bytes, offset, length, UTF_8))
