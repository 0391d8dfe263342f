package skein.ros

/** Quality of service of a topic, as ROS 2 names it; keep-last and volatile. A reliable publisher serves
  * every subscription, and a best-effort subscription takes from every publisher.
  *
  * @param isReliable whether lost messages are sent again
  * @param depth maximum number of messages kept for a reader that is behind
  */
final case class Qos(isReliable: Boolean, depth: Int):
  require(depth > 0, s"depth: expected at least 1, got $depth")

object Qos:
  val Reliable: Qos   = Qos(isReliable = true, depth = 10)
  val BestEffort: Qos = Qos(isReliable = false, depth = 10)
