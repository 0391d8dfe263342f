package skein.lanes

import skein.forward.LoopTiming

object TestLoops:
  /** The loops without predictions: each with default settings, and `stream` also with other settings. */
  val unpredicted: Seq[LoopTiming] = Seq(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true)
  )
