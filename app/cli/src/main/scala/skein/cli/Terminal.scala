package skein.cli

import java.io.{FileDescriptor, FileOutputStream, OutputStream, PrintStream}
import java.nio.charset.{Charset, StandardCharsets}
import org.jline.terminal.TerminalBuilder
import scala.util.{Try, Using}

/** Adapts the outputs of commands to the terminal. */
private[cli] object Terminal:

  /** Replacements for characters that a terminal cannot show. */
  private val plain: Map[Char, String] = Map(
    '─' -> "-",
    '│' -> "|",
    '█' -> "#",
    '▌' -> "#",
    '…' -> "...",
    '—' -> "-",
    '–' -> "-",
    '−' -> "-",
    '±' -> "+/-",
    '×' -> "x",
    '·' -> ".",
    '°' -> " deg",
    'µ' -> "u",
    '≤' -> "<=",
    '≥' -> ">=",
    '²' -> "^2",
    '“' -> "\"",
    '”' -> "\"",
    '’' -> "'"
  )

  def isThere: Boolean = System.console() != null && System.console().isTerminal

  /** Columns of the terminal; None if there is none, or it does not report them. */
  def width: Option[Int] =
    if !isThere then None
    else Try(Using.resource(TerminalBuilder.builder().dumb(true).build())(_.getWidth)).toOption.filter(_ > 0)

  /** Makes both outputs readable on terminals with another charset, such as ASCII. To be called before
    * anything is printed.
    */
  def adapt(): Unit =
    if !knows(System.out.charset) then System.setOut(stream(FileDescriptor.out, System.out.charset))
    if !knows(System.err.charset) then System.setErr(stream(FileDescriptor.err, System.err.charset))

  private def knows(charset: Charset): Boolean = charset.newEncoder.canEncode(plain.keys.mkString)

  private def stream(to: FileDescriptor, charset: Charset) =
    PrintStream(Plain(FileOutputStream(to), charset), true, StandardCharsets.UTF_8)

  /** Accepts UTF-8 and writes the characters that the charset can show, and replacements for the others. */
  private[cli] final class Plain(to: OutputStream, charset: Charset) extends OutputStream:
    private val encoder = charset.newEncoder
    private var waiting = Array.emptyByteArray

    def write(byte: Int): Unit = write(Array(byte.toByte), 0, 1)

    override def write(bytes: Array[Byte], from: Int, count: Int): Unit = synchronized:
      val all  = waiting ++ bytes.slice(from, from + count)
      val most = wholeLetters(all)
      waiting = all.drop(most)
      val text = String(all, 0, most, StandardCharsets.UTF_8)
      to.write(
        text.flatMap(c => if encoder.canEncode(c) then c.toString else plain.getOrElse(c, "?")).getBytes(
          charset
        )
      )

    override def flush(): Unit = to.flush()

    /** Number of bytes up to the end of the last complete character. */
    private def wholeLetters(bytes: Array[Byte]): Int =
      val start = bytes.lastIndexWhere(byte => (byte & 0xc0) != 0x80)
      if start < 0 then bytes.length
      else
        val lead = bytes(start) & 0xff
        val size = if lead < 0x80 then 1 else if lead < 0xe0 then 2 else if lead < 0xf0 then 3 else 4
        if bytes.length - start >= size then bytes.length else start
