package skein.flight

import skein.units.*

/** Whether a simulator that is asked all the time answers.
  *
  * @param silentSince when the last answer came, while it is silent
  */
private[flight] final case class SignsOfLife(silentSince: Option[Instant] = None):
  import SignsOfLife.*

  /** @param heardAt when the newest answer came
    * @param within which an answer is to come
    * @return and what is to be told
    */
  def look(heardAt: Instant, now: Instant, within: Span): (SignsOfLife, Option[Sign]) = silentSince match
    case None if now.since(heardAt) > within =>
      (SignsOfLife(Some(heardAt)), Some(Sign.Silent(now.since(heardAt))))
    case Some(since) if heardAt > since => (SignsOfLife(), Some(Sign.Back(heardAt.since(since))))
    case _                              => (this, None)

private[flight] object SignsOfLife:
  enum Sign:
    /** Nothing has come for so long. */
    case Silent(lasts: Span)

    /** It was silent for so long, and answers again. */
    case Back(after: Span)
