package skein.view

/** Limits of viewers.
  *
  * @param connections maximum number of open connections; further ones are closed immediately
  * @param messageBytes maximum size of one message of a viewer, bytes
  * @param subscriptions maximum number of subscriptions of one viewer
  * @param refusals maximum number of invalid messages of one viewer; one more disconnects it
  * @param waiting maximum number of messages of each subscription that wait for one viewer
  * @param waitingBytes maximum total size of the messages that wait for one viewer, bytes
  */
final case class ViewerLimits(
    connections: Int = 32,
    messageBytes: Int = 64 * 1024,
    subscriptions: Int = 1024,
    refusals: Int = 16,
    waiting: Int = 512,
    waitingBytes: Long = 2L * 1024 * 1024
)

object ViewerLimits:
  /** Limits for recordings. A seek shows everything before it in one turn, which may be 40 s of twenty
    * vehicles. Viewers share the bytes.
    */
  val OfRecording: ViewerLimits = ViewerLimits(waiting = 65_536, waitingBytes = 64L * 1024 * 1024)
