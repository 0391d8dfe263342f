package skein.measure

import skein.scenario.{Track, Window}
import skein.units.*

/** The horizontal distance between two vehicles at equal instants of the simulator's clock.
  *
  * @param points one every 20 ms: time since both vehicles had first been read, s, and distance, m; never
  *   empty
  */
final case class DistanceCurve private (points: Vector[(Double, Double)]):

  /** Time of the closest approach, s, and its distance, m. */
  val closest: (Double, Double) = points.minBy(_._2)

  /** Distances over the last 10 s, evenly spaced in time, m; absent for a shorter curve. */
  val lastTenSeconds: Option[Distribution] =
    Window.Last(10).of(points.indices, DistanceCurve.step.toSeconds).flatMap(instants =>
      Distribution.of(instants.map(points(_)._2))
    )

object DistanceCurve:
  private val step = Span.ofMillis(20)

  /** The curve over the time that both tracks cover; None if there is no such time. */
  def between(one: Track, other: Track): Option[DistanceCurve] =
    val from = one.from.max(other.from)
    val to   = one.to.min(other.to)
    Option.when(from < to):
      val count = to.since(from).toNanos / step.toNanos + 1
      DistanceCurve(Vector.tabulate(count.toInt): index =>
        val time = from + step * index
        (time.since(from).toSeconds, one.at(time).horizontalDistance(other.at(time))))
