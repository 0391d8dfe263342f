package skein.mcap

/** A file's content as text, a line for each item, in the format of `telling.py`. */
object Told:
  private def hex(bytes: Bytes)   = if bytes.size == 0 then "-" else ConformanceGolden.hex(bytes)
  private def text(value: String) = hex(Bytes.utf8(value))
  private def time(value: Long)   = java.lang.Long.toUnsignedString(value)
  private def map(entries: Iterable[(String, String)]) =
    if entries.isEmpty then "-"
    else entries.map((key, value) => s"${text(key)}=${text(value)}").mkString(",")

  def message(found: TopicMessage): String =
    import found.channel
    val one    = found.message
    val schema =
      found.schema.fold("none")(named => s"${text(named.name)} ${text(named.encoding)} ${hex(named.data)}")
    s"message ${text(channel.topic)} ${text(channel.messageEncoding)} ${map(channel.metadata)} $schema " +
      s"${one.sequence} ${time(one.logTime)} ${time(one.publishTime)} ${hex(one.data)}"

  def attachment(one: Record.Attachment): String =
    s"attachment ${time(one.logTime)} ${time(one.createTime)} " +
      s"${text(one.name)} ${text(one.mediaType)} ${hex(one.data)}"

  def metadata(one: Record.Metadata): String = s"metadata ${text(one.name)} ${map(one.metadata)}"
