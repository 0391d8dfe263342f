package skein.view

/** Ways in which the page can control a flight. */
enum FlightControl:
  /** Its vehicles hover and no decisions are made, until it continues or ends. */
  case Pause

  case Continue

  case Abort

  def word: String = toString.toLowerCase(java.util.Locale.ROOT)
