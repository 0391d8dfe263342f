package skein.measure

import skein.scenario.Track
import skein.units.*

/** The horizontal distance between two vehicles at equal instants of the simulator's clock.
  *
  * @param points seconds since both were first seen, every 20 ms, and metres; never empty
  */
final case class DistanceCurve private (points: Vector[(Double, Double)]):

  /** When they were closest, s, and how close, m. */
  val closest: (Double, Double) = points.minBy(_._2)

  /** Distances over the last 10 s, evenly spaced in time, m; absent for a curve that has not as much. */
  val lastTenSeconds: Option[Distribution] =
    val end = points.last._1
    if end < 10 - DistanceCurve.marginS then None
    else Distribution.of(points.collect { case (time, distance) if time >= end - 10 => distance })

object DistanceCurve:
  private val step = Span.ofMillis(20)

  /** Readings begin after a flight's start and end before its end, s. */
  private val marginS = 0.5

  /** Over the time for which both tracks run; none if there is no such time. */
  def between(one: Track, other: Track): Option[DistanceCurve] =
    val from = one.from.max(other.from)
    val to   = one.to.min(other.to)
    Option.when(from < to):
      val count = to.since(from).toNanos / step.toNanos + 1
      DistanceCurve(Vector.tabulate(count.toInt): index =>
        val time = from + step * index
        (time.since(from).toSeconds, one.at(time).horizontalDistance(other.at(time))))
