package skein.view

/** What may be done to a flight from the page. */
enum FlightControl:
  /** Its vehicles hover and no decisions are made, until it continues or ends. */
  case Pause

  case Continue

  /** Ends the flight; its vehicles hover. */
  case Abort

  def word: String = toString.toLowerCase(java.util.Locale.ROOT)
