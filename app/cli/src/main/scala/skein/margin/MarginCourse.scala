package skein.margin

import skein.units.{Instant, Span}

/** The duration of a run so far, and the times at which messages passed between program and simulator.
  *
  * @param at time of the last observation
  * @param passed time from the first message to the last one
  * @param passedAt when the last message was noticed; before the first message, the start
  */
private[margin] final case class MarginCourse(
    startedAt: Instant,
    at: Instant,
    passed: Span,
    passedAt: Instant
):
  def lasted: Span = at.since(startedAt)

  def silentFor: Span = at.since(passedAt)

  def looked(now: Instant, passed: Span): MarginCourse =
    if passed > this.passed then copy(at = now, passed = passed, passedAt = now) else copy(at = now)

private[margin] object MarginCourse:
  def apply(startedAt: Instant): MarginCourse = MarginCourse(startedAt, startedAt, Span.Zero, startedAt)
