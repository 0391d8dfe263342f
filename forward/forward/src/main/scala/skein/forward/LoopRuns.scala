package skein.forward

private[skein] object LoopRuns:
  def of(timing: LoopTiming, world: RolloutWorld): LoopRun = timing match
    case paused: LoopTiming.Paused         => PausedRun(paused, world)
    case sequential: LoopTiming.Sequential => SequentialRun(sequential, world)
    case futures: LoopTiming.Futures       => FuturesRun(futures, world)
    case stream: LoopTiming.Stream         => StreamRun(stream, world)
    case predictive: LoopTiming.Predictive => PredictiveRun(predictive, world)
