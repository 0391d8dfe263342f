package skein.loop

import skein.flow.Sense
import skein.forward.{Asking, LoopTiming, Steering}
import skein.port.Moves
import skein.units.*

/** The timing of the live loops, for forward simulation. */
object LoopTimings:
  /** The timing of a loop. Absent for `plan`, whose decisions are themselves forward simulations. */
  def of(kind: LoopKind, settings: LoopSettings): Option[LoopTiming] =
    val periodS = settings.period.toSeconds
    val asking  = Asking(
      settings.window,
      spreadS = settings.spread.toSeconds,
      inOrder = settings.early == Sense.Early.Waits
    )
    val steering =
      Steering(settings.minCommandInterval.toSeconds, settings.movesInFlight, Moves.HandoverAllowed.toSeconds)
    kind match
      case LoopKind.Paused     => Some(LoopTiming.Paused(periodS))
      case LoopKind.Sequential => Some(LoopTiming.Sequential(periodS, asking, steering))
      case LoopKind.Futures    => Some(LoopTiming.Futures(periodS, asking, steering))
      case LoopKind.Stream     =>
        Some(
          LoopTiming.Stream(
            periodS,
            (settings.period - settings.paceInterval).toSeconds,
            settings.patience.toSeconds,
            settings.decideThenPace,
            asking,
            steering
          )
        )
      case LoopKind.Predictive => Some(LoopTiming.Predictive(periodS, settings.model(0), asking, steering))
      case LoopKind.Plan       => None
