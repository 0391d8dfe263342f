package skein.simulator

import skein.units.Instant

/** The vehicles of a simulation behind a protocol other than AirSim's: bytes of peers go in, bytes for them
  * come out. Not thread-safe.
  */
private[simulator] trait PeerProtocol:
  /** @param systems system numbers of the vehicles that the peer sees; empty: all
    * @param isDatagrams whether it sends datagrams, and not a stream
    */
  def join(channel: Long, systems: Vector[Int], isDatagrams: Boolean): Unit

  def leave(channel: Long): Unit

  /** Handles bytes from a peer; the simulation must have been advanced to the present first. */
  def receive(channel: Long, bytes: Array[Byte]): Unit

  /** Takes the datagrams that are due for each peer. */
  def take(): Vector[(channel: Long, datagrams: Vector[Array[Byte]])]

  /** The time at which the next message is due, on the simulator's clock. */
  def nextDue: Option[Instant]

  /** Messages of all peers since the start that could not be read. */
  def damaged: Long

  /** Number of times that an autopilot did not answer, and physics continued without it. */
  def unanswered: Long
