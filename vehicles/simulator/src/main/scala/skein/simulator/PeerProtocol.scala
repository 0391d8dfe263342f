package skein.simulator

import skein.units.Instant

/** The vehicles of a simulation by another protocol than AirSim's: bytes of peers go in, bytes for them come
  * out. Not thread-safe.
  */
private[simulator] trait PeerProtocol:
  /** @param systems that the peer sees; none is all
    * @param isDatagrams whether it speaks by datagrams, and not by a stream
    */
  def join(channel: Long, systems: Vector[Int], isDatagrams: Boolean): Unit

  def leave(channel: Long): Unit

  /** Takes in what a peer has sent, now: time was let pass before. */
  def receive(channel: Long, bytes: Array[Byte]): Unit

  /** What is due for each peer, in datagrams. */
  def take(): Vector[(channel: Long, datagrams: Vector[Array[Byte]])]

  /** When something is to be told next, on the simulator's clock. */
  def nextDue: Option[Instant]

  /** Messages of all peers since the start that could not be read. */
  def damaged: Long

  /** Times that an autopilot did not answer, and time went on without it. */
  def unanswered: Long
