package skein.view

import java.nio.charset.StandardCharsets.UTF_8
import java.security.{MessageDigest, SecureRandom}
import java.util.HexFormat

/** A word that only who reads the terminal knows: with it a flight can be ended from the page. */
final class Token private (val word: String):
  /** Takes as long for a wrong word as for the right one. */
  def is(said: String): Boolean = MessageDigest.isEqual(word.getBytes(UTF_8), said.getBytes(UTF_8))

object Token:
  def apply(word: String): Token = new Token(word)

  def drawn(): Token =
    val bytes = new Array[Byte](8)
    SecureRandom().nextBytes(bytes)
    Token(HexFormat.of.formatHex(bytes))
