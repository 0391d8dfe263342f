package skein.scenario

/** The part of a flight that a measure covers. */
enum Window:
  case Whole

  /** The last `seconds` of the flight; a shorter flight has no such part. */
  case Last(seconds: Double)

  /** The time after the first `seconds`; for a shorter flight, the whole flight. */
  case After(seconds: Double)

  def of(tracks: Tracks): Option[Range] = of(tracks.instants, tracks.stepS)

  /** Indices of the instants within this part. The instants are `stepS` seconds apart and start at 0. */
  def of(instants: Range, stepS: Double): Option[Range] = this match
    case Whole          => Some(instants)
    case After(seconds) =>
      val settled = instants.dropWhile(_ * stepS < seconds)
      Some(if settled.isEmpty then instants else settled)
    case Last(seconds) =>
      val many = (seconds / stepS).toInt
      Option.when(instants.size >= 0.95 * many)(instants.drop(instants.size - 1 - many max 0))
