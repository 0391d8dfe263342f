package skein.cli

import skein.report.Paragraph

/** Formats the text that `--help` prints for a command. */
private[cli] object HelpText:

  /** A value's placeholder in usage lines.
    *
    * @param option the option's name without dashes
    * @param kind the type's name in mainargs
    */
  def placeholder(option: String, kind: String): String =
    Named.getOrElse(
      option,
      kind match
        case "int" | "long"     => "N"
        case "double" | "float" => "X"
        case _                  => option.replaceAll("^.*-", "").toUpperCase(java.util.Locale.ROOT)
    )

  def of(command: String, summary: String, options: Seq[CommandOption], width: Int): String =
    val (flags, operands) = options.partition(_.flag.nonEmpty)
    val usage             = s"./skein $command [OPTION…]${operands.flatMap(_.value).map(" " + _).mkString}"
    val rows              = (operands ++ flags).map: option =>
      val head    = (Seq(option.flag).filter(_.nonEmpty) ++ option.value).mkString(" ")
      val default = option.default.fold("")(value => s" (default: $value)")
      head -> (option.summary + default)
    val column = rows.map(_._1.length).maxOption.getOrElse(0).min(width / 3)
    val lines  = rows.flatMap: (head, says) =>
      val wrapped = Paragraph.lines(says, width - column - 4)
      val first   =
        if head.length <= column then Vector(s"  ${head.padTo(column, ' ')}  ${wrapped.head}")
        else Vector(s"  $head", " " * (column + 4) + wrapped.head)
      first ++ wrapped.tail.map(" " * (column + 4) + _)
    (usage +: (Paragraph.lines(summary, width) ++ lines)).mkString("", "\n", "\n")

  /** Placeholders for options whose type and name do not suggest one. */
  private val Named: Map[String, String] =
    def all(word: String, options: String*) = options.map(_ -> word)
    Map.from(
      all(
        "TIME",
        "duration",
        "period",
        "deadline",
        "lesson",
        "horizon",
        "patience",
        "at-jitter",
        "most-jitter",
        "most-mean",
        "reset-every",
        "stall-every",
        "stall-lasts"
      ) ++
        all("FOLDER", "out", "learn", "resume", "tls", "parquet") ++
        all("FILE", "config", "settings", "mcap", "onnx", "conf", "file", "recording") ++
        all("FILE…", "files") ++
        all("HOST:PORT", "simulator", "listen", "to", "join", "cluster") ++
        all("LATENCY", "link", "profile", "to-client", "to-server") ++
        Seq(
          "set"    -> "NAME=VALUE",
          "vary"   -> "NAME=LOW..HIGH",
          "start"  -> "LEAST..MOST",
          "words"  -> "certificates FOLDER",
          "record" -> "FORMAT"
        )
    )
