package skein.environment

import java.util.concurrent.ConcurrentHashMap
import skein.lanes.timetable.Timetable
import skein.simd.WorldRandom

/** What befalls the messages of a run, drawn from a fixed number of flights over the link. Each is told once.
  * Any thread may ask.
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
  /** Of some 200 kB for a minute each. */
  val Flights = 128

  def indexOf(draw: Long): Int = ((draw >>> 1) % Flights).toInt

  /** By which the delays of a flight are drawn. */
  def keyOf(index: Int): Int = WorldRandom.key(1, 0, index)
