package skein.lanes

import skein.forward.LoopTiming

/** What vehicles whose commands act at times of their own have to know of a loop.
  *
  * @param keptRows periods before, of which a reading may ask for the flight
  * @param longestS a command is under way at most
  */
private[lanes] final case class FlightTiming(loop: LoopTiming, keptRows: Int, longestS: Double)
