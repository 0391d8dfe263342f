package skein.search

import java.nio.charset.StandardCharsets.UTF_8
import scala.collection.immutable.ArraySeq
import upickle.default.{Reader, Writer, read as readJson, write as writeJson}

/** JSON for messages between processes and for stored states. */
private[skein] object JsonText:

  def bytes[A: Writer](value: A): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(writeJson(value).getBytes(UTF_8))

  /** @param what the bytes should be, in words
    * @return Left says what was expected and what was received
    */
  def read[A: Reader](bytes: ArraySeq[Byte], what: String): Either[String, A] =
    parse(String(bytes.toArray, UTF_8), what)

  /** Parses a value from a text, in the manner of `read`. */
  def parse[A: Reader](text: String, what: String): Either[String, A] =
    try Right(readJson[A](text))
    catch case mistake: Exception => Left(s"expected $what, got: ${mistake.getMessage}")
