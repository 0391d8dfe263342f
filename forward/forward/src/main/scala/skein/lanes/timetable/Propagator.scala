package skein.lanes.timetable

import skein.units.Span

/** Computes the propagations from a vehicle's reading. Immutable: it holds the model's state of commands at
  * that reading.
  */
private[lanes] trait Propagator:
  /** The propagator of the next reading, after these legs. */
  def next(legs: Vector[Propagator.Leg]): Propagator

  /** The propagation from the reading through these legs. */
  def predicted(legs: Vector[Propagator.Leg]): Propagation

private[lanes] object Propagator:
  /** A [[skein.forecast.Leg]].
    *
    * @param decision of its command; 0 if none was sent yet
    */
  final case class Leg(decision: Int, span: Span)
