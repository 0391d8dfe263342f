package skein.view

import skein.units.{Instant, Span}

/** The position in a recording during playback: a pure clock that can stop, seek and run at another speed.
  *
  * @param start the recording's first time
  * @param end the recording's last time, at which playback stops
  * @param at position in the recorded time at `since`
  * @param since the time of that position, on the caller's clock
  * @param speed recorded seconds per second, more than 0
  */
final case class Playback private (
    start: Instant,
    end: Instant,
    at: Instant,
    since: Instant,
    speed: Double,
    playing: Boolean
):
  def position(now: Instant): Instant =
    if !playing then at
    else
      val passed = Span.ofNanos(math.round(now.since(since).toNanos.max(0) * speed))
      if passed >= end.since(at) then end else at + passed

  def hasEnded(now: Instant): Boolean = position(now) >= end

  /** Plays or stops, from the current position or from another, which is clamped to start and end. Playing
    * from the end starts again from the beginning.
    */
  def controlled(playing: Boolean, speed: Double, seek: Option[Instant], now: Instant): Playback =
    val wanted = seek.getOrElse(position(now))
    val from   = if playing && seek.isEmpty && wanted >= end then start else wanted.max(start).min(end)
    copy(at = from, since = now, speed = speed, playing = playing)

object Playback:
  val MostSpeed = 100.0

  def apply(start: Instant, end: Instant): Playback =
    Playback(start, end.max(start), start, start, speed = 1, playing = false)
