package skein.vehicle

import skein.units.OwnFailure

/** A vehicle simulated by a plant, from one event to the next, whose steps begin with a command and every
  * [[PlantTiming.stepS]] after that. Mutable. How its time is cut into calls of [[advance]] does not change
  * the flight, but for rounding. An exception in the plant's step becomes an [[skein.units.OwnFailure]].
  *
  * @param initial its state before it is set to another
  */
abstract class StepwiseFlight[S](timing: PlantTiming, initial: S):
  private var stepAtS = 0.0
  private var from    = initial // when the present step began
  private var now     = from

  def state: S = now

  /** The plant's step under the command in effect. */
  protected def stepped(from: S, spanS: Double): S

  protected final def begin(atS: Double, state: S): Unit =
    now = state
    beginStep(atS)

  protected final def beginStep(atS: Double): Unit =
    stepAtS = atS
    from = now

  /** Simulates until this time, s; times must not decrease. */
  final def advance(untilS: Double): Unit =
    while untilS > stepAtS + timing.stepS do
      fly(timing.stepS)
      beginStep(stepAtS + timing.stepS)
    if untilS > stepAtS then fly(untilS - stepAtS)

  private def fly(spanS: Double): Unit =
    now = OwnFailure.told(OwnFailure.named("plant", timing))(stepped(from, spanS))
