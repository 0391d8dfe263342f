package skein.scenario

/** The part of a flight to which a measure refers. */
enum Window:
  case Whole

  /** The last `seconds`; a shorter flight has no such part. */
  case Last(seconds: Double)

  /** All after the first `seconds`; of a shorter flight, the whole. */
  case After(seconds: Double)

  def of(tracks: Tracks): Option[Range] = of(tracks.instants, tracks.stepS)

  /** The instants within this part, for instants `stepS` seconds apart that start at 0. */
  def of(instants: Range, stepS: Double): Option[Range] = this match
    case Whole          => Some(instants)
    case After(seconds) =>
      val settled = instants.dropWhile(_ * stepS < seconds)
      Some(if settled.isEmpty then instants else settled)
    case Last(seconds) =>
      val many = (seconds / stepS).toInt
      Option.when(instants.size >= 0.95 * many)(instants.drop(instants.size - 1 - many max 0))
