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
      define(schemas, schema.id, schema, "schema", at)(_.name)
    case channel: Record.Channel =>
      if channel.schemaId != 0 && !schemas.contains(channel.schemaId) then
        val came = s"${channel.topic} of ${channel.schemaId}"
        Refused.malformed(at, "a channel of a schema named before", came)
      define(channels, channel.id, channel, "channel", at)(_.topic)
    case _ => true

  /** Records a definition; refuses another one of an identifier that has one. */
  private def define[A](known: mutable.LongMap[A], id: Int, record: A, kind: String, at: Place)(
      name: A => String
  ): Boolean =
    val first = known.getOrElseUpdate(id, record)
    if first != record then
      Refused.malformed(at, s"$kind $id as it was named before, ${name(first)}", name(record))
    true
