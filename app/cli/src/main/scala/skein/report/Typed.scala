package skein.report

import java.nio.file.Path

/** Quotes what a person is to type into a shell, which would misread names with spaces or quotation marks. */
private[skein] object Typed:

  /** A path as one shell word that is not an option. */
  def path(path: Path): String = word(if path.toString.startsWith("-") then s"./$path" else path.toString)

  def word(text: String): String =
    if text.matches("[\\p{L}\\p{N}._/+@%-]+") then text else s"'${text.replace("'", "'\\''")}'"

  /** The pattern of all recordings of a folder: the star must stay outside the quotation marks. */
  def recordings(folder: Path): String =
    val all = "*.duckdb"
    if folder.toString.isEmpty then all else s"${path(folder)}/$all"
