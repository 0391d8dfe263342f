package skein.view

import java.nio.charset.StandardCharsets.UTF_8
import java.security.{MessageDigest, SecureRandom}
import java.util.HexFormat

/** A secret printed in the terminal: with it the page can control a flight. */
final class Token private (val word: String):
  /** Compares in constant time, independent of how much of the word is right. */
  def is(said: String): Boolean = MessageDigest.isEqual(word.getBytes(UTF_8), said.getBytes(UTF_8))

object Token:
  def apply(word: String): Token = new Token(word)

  def drawn(): Token =
    val bytes = new Array[Byte](8)
    SecureRandom().nextBytes(bytes)
    Token(HexFormat.of.formatHex(bytes))
