package skein.observe

import skein.units.Instant

/** A message between a client and its simulator that passed the observer. Instants are on the observer's
  * clock.
  */
enum Passed:
  case Opened(connection: Int, at: Instant)

  /** A call on its way to the simulator.
    *
    * @param id identifies the call within its connection
    * @param vehicle its name in the call; empty for the simulator's default vehicle
    */
  case Called(connection: Int, id: Long, method: String, vehicle: String, at: Instant)

  /** An answer on its way to the client.
    *
    * @param error absent if the call succeeded
    * @param sampledAt the answer's time stamp, on the simulator's clock
    * @param bytes size of the whole answer
    */
  case Answered(
      connection: Int,
      id: Long,
      error: Option[String],
      sampledAt: Option[Instant],
      bytes: Long,
      at: Instant
  )

  /** Bytes that are not MessagePack-RPC: the rest of this connection is not analysed, but still passes. */
  case Unreadable(connection: Int, reason: String, at: Instant)

  case Closed(connection: Int, at: Instant)
