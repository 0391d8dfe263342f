package skein.mcap

/** Which messages, in which order.
  *
  * @param from earliest log time, ns, unsigned
  * @param until log times before it, ns, unsigned; none for no bound
  * @param topics none for all
  */
final case class Query(
    from: Long = 0,
    until: Option[Long] = None,
    topics: Option[Set[String]] = None,
    order: Query.Order = Query.Order.LogTime
):
  private[mcap] def wants(time: Long): Boolean =
    java.lang.Long.compareUnsigned(time, from) >= 0 &&
      until.forall(java.lang.Long.compareUnsigned(time, _) < 0)

  private[mcap] def wants(stretch: Stretch, channels: Set[Int]): Boolean =
    java.lang.Long.compareUnsigned(stretch.endTime, from) >= 0 &&
      until.forall(java.lang.Long.compareUnsigned(stretch.startTime, _) < 0) &&
      stretch.channels.forall(_.exists(channels))

object Query:
  enum Order:
    /** By log time; messages of the same time as they stand in the file. */
    case LogTime

    /** The reverse of `LogTime`. */
    case LatestFirst

    /** As they stand in the file. */
    case File

/** A message and what it is of. */
final case class TopicMessage(channel: Record.Channel, schema: Option[Record.Schema], message: Record.Message)
