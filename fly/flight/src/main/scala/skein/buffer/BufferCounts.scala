package skein.buffer

import skein.units.*

/** Counts of a buffer since its start.
  *
  * @param plans number of accepted plans, each newer than all earlier ones of its vehicle
  * @param stalePlans number of plans without effect: received again, or after a newer one
  * @param refusedPlans number of plans answered with an error
  * @param moves number of moves sent to the simulator
  * @param failedMoves number of sent moves that the simulator refused or did not answer in time
  * @param heldCalls number of clients' calls that waited until a move of the buffer was answered
  * @param latest greatest delay of a move: from its moment, or from its plan's arrival if that was later,
  *   until it was sent; on the simulator's clock
  * @param lostConnections number of connections whose bytes are not MessagePack: all of them pass, plans too
  */
final case class BufferCounts(
    plans: Long = 0,
    stalePlans: Long = 0,
    refusedPlans: Long = 0,
    moves: Long = 0,
    failedMoves: Long = 0,
    heldCalls: Long = 0,
    latest: Span = Span.Zero,
    lostConnections: Long = 0
)
