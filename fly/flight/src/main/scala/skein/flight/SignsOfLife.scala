package skein.flight

import skein.units.*

/** Whether a periodically read simulator answers.
  *
  * @param silentSince time of the last answer, while it is silent
  */
private[flight] final case class SignsOfLife(silentSince: Option[Instant] = None):
  import SignsOfLife.*

  /** Updates the state.
    *
    * @param heardAt time of the newest answer
    * @param within time-out of an answer
    * @return the new state, and what to report
    */
  def look(heardAt: Instant, now: Instant, within: Span): (SignsOfLife, Option[Sign]) = silentSince match
    case None if now.since(heardAt) > within =>
      (SignsOfLife(Some(heardAt)), Some(Sign.Silent(now.since(heardAt))))
    case Some(since) if heardAt > since => (SignsOfLife(), Some(Sign.Back(heardAt.since(since))))
    case _                              => (this, None)

private[flight] object SignsOfLife:
  enum Sign:
    /** No answer was received for this time. */
    case Silent(lasts: Span)

    /** It answers again after this time of silence. */
    case Back(after: Span)
