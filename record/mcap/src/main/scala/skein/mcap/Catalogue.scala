package skein.mcap

import scala.collection.mutable

/** The schemas and channels that a file has defined so far; checks references to them. */
private[mcap] final class Catalogue:
  private val schemas  = mutable.LongMap.empty[Record.Schema]
  private val channels = mutable.LongMap.empty[Record.Channel]

  def schema(id: Int): Option[Record.Schema]   = schemas.get(id)
  def channel(id: Int): Option[Record.Channel] = channels.get(id)

  /** Records a schema's or a channel's definition; refuses a reference to an undefined one. Returns whether
    * the record counts: readers must skip a schema with the identifier 0.
    */
  def takes(record: Record, at: Place): Boolean = record match
    case message: Record.Message =>
      if !channels.contains(message.channelId) then
        Refused.malformed(at, "a message of a channel named before", s"one of channel ${message.channelId}")
      true
    case schema: Record.Schema if schema.id == 0 => false
    case schema: Record.Schema                   =>
      schemas.getOrElseUpdate(schema.id, schema) match
        case known if known != schema =>
          Refused.malformed(
            at,
            s"schema ${schema.id} as it was named before, ${known.name}",
            s"${schema.name}"
          )
        case _ => true
    case channel: Record.Channel =>
      if channel.schemaId != 0 && !schemas.contains(channel.schemaId) then
        Refused.malformed(
          at,
          "a channel of a schema named before",
          s"${channel.topic} of ${channel.schemaId}"
        )
      channels.getOrElseUpdate(channel.id, channel) match
        case known if known != channel =>
          Refused.malformed(
            at,
            s"channel ${channel.id} as it was named before, ${known.topic}",
            s"${channel.topic}"
          )
        case _ => true
    case _ => true
