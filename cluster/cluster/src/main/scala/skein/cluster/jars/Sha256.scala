package skein.cluster.jars

import java.io.OutputStream
import java.nio.file.{Files, Path}
import java.security.{DigestOutputStream, MessageDigest}
import java.util.HexFormat

/** Names bytes by what they are: 64 small hexadecimal digits. */
final case class Sha256 private (hex: String):
  override def toString: String = hex

object Sha256:
  def parse(text: String): Either[String, Sha256] =
    Either.cond(
      text.matches("[0-9a-f]{64}"),
      Sha256(text),
      s"expected a SHA-256, 64 digits of 0-9 and a-f, came '${text.take(80)}'"
    )

  def of(bytes: Array[Byte]): Sha256 = told(algorithm().digest(bytes))

  def of(file: Path): Sha256 = written(Files.copy(file, _): Unit)._1

  /** Of what is written, and its length; nothing of it is kept. */
  private[jars] def written(write: OutputStream => Unit): (Sha256, Long) =
    var bytes = 0L
    val none  = new OutputStream:
      def write(byte: Int): Unit                                            = bytes += 1
      override def write(some: Array[Byte], offset: Int, length: Int): Unit = bytes += length
    val out = DigestOutputStream(none, algorithm())
    write(out)
    (told(out.getMessageDigest.digest()), bytes)

  private[jars] def algorithm(): MessageDigest = MessageDigest.getInstance("SHA-256")

  private[jars] def told(digest: Array[Byte]): Sha256 = Sha256(HexFormat.of.formatHex(digest))
