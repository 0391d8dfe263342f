package skein.mcap

/** A message with its channel, and with the channel's schema if it has one. */
final case class TopicMessage(channel: Record.Channel, schema: Option[Record.Schema], message: Record.Message)
