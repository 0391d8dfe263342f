package skein.view

/** What viewers may take.
  *
  * @param connections open at once; one more is closed at once
  * @param messageBytes of one message of a viewer
  * @param subscriptions of one viewer
  * @param refusals messages of one viewer that are none, before it is turned out
  * @param waiting messages that wait for one viewer, of each of its subscriptions
  * @param waitingBytes of all that waits for one viewer
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
  /** A jump within a recording shows at once all that came before: 40 s of twenty vehicles. Viewers share the
    * bytes.
    */
  val OfRecording: ViewerLimits = ViewerLimits(waiting = 65_536, waitingBytes = 64L * 1024 * 1024)
