package skein.ros

import scala.collection.mutable

/** Counts messages of a topic that were lost in transit here, by the sequence numbers that middleware gives
  * to each publisher's messages. Middleware that gives none repeats one number, and nothing counts as lost.
  * One thread adds; any may read. Remembers the newest [[LostMessages.MostPublishers]] publishers.
  */
private[ros] final class LostMessages:
  private val newest         = mutable.LinkedHashMap.empty[(Long, Long), Long]
  @volatile private var lost = 0L

  def count: Long = lost

  /** Adds a message that was received.
    *
    * @param publisher the publisher's identifier, 16 bytes
    * @param number sequence number of the message among all messages of its publisher
    */
  def add(publisher: (Long, Long), number: Long): Unit = newest.get(publisher) match
    case Some(before) =>
      if number > before then
        lost += number - before - 1
        newest(publisher) = number
    case None =>
      newest(publisher) = number
      if newest.size > LostMessages.MostPublishers then newest -= newest.head._1

private object LostMessages:
  val MostPublishers = 64
