package skein.optimise

/** Whether a search minimises or maximises its objective. */
enum Direction(val sign: Double):
  case Minimise extends Direction(1)
  case Maximise extends Direction(-1)

  def text: String = productPrefix.toLowerCase(java.util.Locale.ROOT)
