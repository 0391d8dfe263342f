package skein.buffer

import skein.units.*

/** Counts of a buffer since its start.
  *
  * @param plans taken, newer than all before of their vehicle
  * @param stalePlans that arrived again, or after a newer one
  * @param refusedPlans answered with an error
  * @param moves sent to the simulator
  * @param failedMoves of these, that it refused or did not answer in time
  * @param heldCalls of clients, that waited for a move of the buffer to be answered
  * @param latest the longest time from a move's moment, or from its plan's arrival if that was later, to its
  *   sending; on the simulator's clock
  * @param lostConnections whose bytes are no MessagePack: they pass, and no plans are taken from them
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
