package skein.ros

import skein.units.Instant

/** The topics of a graph of ROS 2, of any types, as a node sees them. */
trait RosGraph extends AutoCloseable:

  /** Subscribes to a topic of any type, as serialized messages.
    *
    * @param kind such as `nav_msgs/msg/Odometry`; its package must be installed
    * @param most maximum number of bytes of a message that are handed over; the rest is not copied
    * @param receive called for each message on the node's thread with its first bytes and its arrival time on
    *   the system's clock: the middleware's, or else the time at which it was read
    * @return Left if the package is not installed, or ROS 2 rejects the topic, with the reason
    */
  def subscribeRaw(topic: String, kind: String, qos: Qos, most: Int)(
      receive: (Array[Byte], Instant) => Unit
  ): Either[String, Unit]

  /** The text of a type's `.msg` file, if its package is installed with it, and else an empty text. */
  def definition(kind: String): String

  /** Received messages that were malformed, longer than 64 MiB, or of no use. */
  def refused: Long

  /** Messages that were published and did not arrive, as far as middleware numbers them. */
  def lost: Long

  /** The problems so far, each kind once: the first malformed message of a topic, and topics that others use
    * with another type, so that nothing is received from them. At most 16 lines.
    */
  def notes: Vector[String]

/** Watches a graph: called on a node's thread, so each call must return soon. */
trait RosWatcher:

  /** Receives all topics of the graph with their types, twice a second. */
  def topics(found: Vector[(String, Vector[String])]): Unit

  /** Is called once all messages that had arrived by `at` are handed over, except those beyond 64 of a topic.
    */
  def upTo(at: Instant): Unit
