package skein.search

import java.nio.charset.StandardCharsets.UTF_8
import scala.collection.immutable.ArraySeq
import upickle.default.{Reader, Writer, read as readJson, write as writeJson}

/** What processes tell one another, and what is kept for later, as JSON. */
private[skein] object JsonText:

  /** In UTF-8. */
  def bytes[A: Writer](value: A): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(writeJson(value).getBytes(UTF_8))

  /** @param what the bytes should be, in words
    * @return or what was expected, and what came
    */
  def read[A: Reader](bytes: ArraySeq[Byte], what: String): Either[String, A] =
    parse(String(bytes.toArray, UTF_8), what)

  /** The same, of text. */
  def parse[A: Reader](text: String, what: String): Either[String, A] =
    try Right(readJson[A](text))
    catch case mistake: Exception => Left(s"expected $what, came: ${mistake.getMessage}")
