package skein.lanes

import skein.forward.LoopTiming

/** The loops that tests fly by lanes. */
object TestLoops:
  /** Those that do not predict, as they are unless told otherwise, and `stream` as it may be told. */
  val unpredicted: Seq[LoopTiming] = Seq(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true)
  )
