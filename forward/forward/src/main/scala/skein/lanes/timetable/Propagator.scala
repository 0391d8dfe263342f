package skein.lanes.timetable

import skein.units.Span

/** Computes propagations from one reading of a vehicle. Immutable; contains the commands that are in effect
  * or pending at that reading.
  */
private[lanes] trait Propagator:
  /** The propagator of the next reading, which these legs lead to. */
  def next(legs: Vector[Propagator.Leg]): Propagator

  /** The propagation from the reading over these legs. */
  def predicted(legs: Vector[Propagator.Leg]): Propagation

private[lanes] object Propagator:
  /** The counterpart of a [[skein.forecast.Leg]].
    *
    * @param decision the decision whose command is in effect; 0 before the first command
    */
  final case class Leg(decision: Int, span: Span)
