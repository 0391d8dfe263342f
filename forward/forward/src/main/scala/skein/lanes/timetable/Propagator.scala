package skein.lanes.timetable

import skein.units.Span

/** Tells by which propagations a reading of one vehicle is carried forward. Immutable: it knows what the
  * model remembers at that reading.
  */
private[lanes] trait Propagator:
  /** That of the next reading, after these legs. */
  def next(legs: Vector[Propagator.Leg]): Propagator

  /** From the reading on through these legs. */
  def predicted(legs: Vector[Propagator.Leg]): Propagation

private[lanes] object Propagator:
  /** A [[skein.forecast.Leg]].
    *
    * @param decision that its command carries; 0: none was sent yet
    */
  final case class Leg(decision: Int, span: Span)
