package skein.optimise

/** Where an objective is to go. */
enum Direction(val sign: Double):
  case Minimise extends Direction(1)
  case Maximise extends Direction(-1)

  def text: String = productPrefix.toLowerCase(java.util.Locale.ROOT)
