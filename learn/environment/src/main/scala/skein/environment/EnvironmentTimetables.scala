package skein.environment

import java.util.concurrent.ConcurrentHashMap
import skein.lanes.timetable.Timetable
import skein.simd.WorldRandom

/** Delays and losses of a run's messages, drawn from a fixed number of flights over the link; each is
  * computed once. Thread-safe.
  */
private final class EnvironmentTimetables(config: EnvironmentSettings.Resolved):
  import EnvironmentTimetables.*
  private val known = ConcurrentHashMap[Int, Timetable]()

  def apply(draw: Long): Timetable =
    known.computeIfAbsent(
      indexOf(draw),
      index => Timetable.of(2, config.duel.durationS, config.timing, config.link, keyOf(index), config.model)
    )

private object EnvironmentTimetables:
  /** Number of flights; some 200 kB for a minute of each. */
  val Flights = 128

  def indexOf(draw: Long): Int = ((draw >>> 1) % Flights).toInt

  /** The key from which a flight's delays are drawn. */
  def keyOf(index: Int): Int = WorldRandom.key(1, 0, index)
