package skein.report

import java.nio.file.Path

/** What a person is to type into a shell, which would take a name with spaces or quotation marks for
  * something else.
  */
private[skein] object Typed:

  /** As one word, and no option. */
  def path(path: Path): String =
    val text = if path.toString.startsWith("-") then s"./$path" else path.toString
    if text.matches("[\\p{L}\\p{N}._/+@%-]+") then text else s"'${text.replace("'", "'\\''")}'"

  /** All recordings of a folder: the star has to stay outside the quotation marks. */
  def recordings(folder: Path): String =
    val all = "*.duckdb"
    if folder.toString.isEmpty then all else s"${path(folder)}/$all"
