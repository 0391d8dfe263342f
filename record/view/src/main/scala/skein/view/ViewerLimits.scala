package skein.view

/** Limits of viewers.
  *
  * @param connections open at a time; further ones are closed immediately
  * @param messageBytes of one message of a viewer
  * @param subscriptions of one viewer
  * @param refusals invalid messages of one viewer, before it is disconnected
  * @param waiting messages of each subscription that wait for one viewer
  * @param waitingBytes of all messages that wait for one viewer
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
  /** Limits for recordings. A seek shows everything before it in one go, which may be 40 s of twenty
    * vehicles. Viewers share the bytes.
    */
  val OfRecording: ViewerLimits = ViewerLimits(waiting = 65_536, waitingBytes = 64L * 1024 * 1024)
