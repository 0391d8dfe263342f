package skein.lanes

import skein.forward.{Delays, Duel, LoopTiming}
import skein.lanes.timetable.Timetable

/** The episodes of duels that fly by timetables.
  *
  * @param duel start, speeds and duration
  */
private[lanes] final class DuelEpisodes(
    val duel: Duel,
    val timing: LoopTiming,
    val model: LaneDynamics,
    val eyes: DuelEyes
):
  private val sensors = Seq(0 -> duel.evader.eye, 1 -> duel.pursuer.eye).collect { case (self, Some(eye)) =>
    self -> eye
  }.toMap

  /** Whether all worlds meet the same: those that wait meet no delays. */
  val areOne: Boolean = timing.isInstanceOf[LoopTiming.Paused] && eyes.isNobody

  /** What tells an episode from others. */
  def of(link: Delays, key: Int): Any = if areOne then () else (link, key)

  def timetable(link: Delays, key: Int): Timetable =
    Timetable.of(2, duel.durationS, timing, link, key, model, sensors)
