package skein.cli

import mainargs.TokensReader

/** Another program's command: the words after `--`, in any form. */
private[cli] final case class Behind(words: Vector[String])

private[cli] object Behind:
  /** Prefix that keeps the parser from reading a word as an option of ours. No argument contains it. */
  private val Mark = "\u0000"

  def marked(word: String): String = Mark + word

  object Reader extends TokensReader.Leftover[Behind, String]:
    def read(words: Seq[String]): Either[String, Behind] =
      Right(Behind(words.map(_.stripPrefix(Mark)).toVector))
    def shortName: String = "word"

  given TokensReader.Leftover[Behind, String] = Reader
