package skein.lanes

import skein.forward.{Delays, Duel, LoopTiming}
import skein.lanes.timetable.Timetable

/** The episodes of duels that timetables support.
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

  /** Whether all worlds have one episode: worlds that wait for their controller have no delays. */
  val areOne: Boolean = timing.isInstanceOf[LoopTiming.Paused] && eyes.isNobody

  /** The key by which an episode differs from others. */
  def of(link: Delays, key: Int): Any = if areOne then () else (link, key)

  def timetable(link: Delays, key: Int): Timetable =
    Timetable.of(2, duel.durationS, timing, link, key, model, sensors)
