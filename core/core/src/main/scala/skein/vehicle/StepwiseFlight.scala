package skein.vehicle

import skein.units.OwnFailure

/** A vehicle that is simulated with a plant, from one event to the next. A step begins with a command, and
  * [[PlantTiming.stepS]] after the begin of the previous step. Mutable. Except for rounding, the division of
  * time into calls of [[advance]] has no effect on the flight. An exception in the plant's step becomes an
  * [[skein.units.OwnFailure]].
  *
  * @param initial the state until another is set
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
