package skein.lanes

import skein.forward.LoopTiming

object TestLoops:
  /** The loops without prediction, with default settings, and `stream` with all others. */
  val unpredicted: Seq[LoopTiming] = Seq(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true)
  )
