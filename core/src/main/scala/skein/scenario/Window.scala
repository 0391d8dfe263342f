package skein.scenario

/** The part of a flight that a measure is of. */
enum Window:
  case Whole

  /** The last `seconds`; a shorter flight has no such part. */
  case Last(seconds: Double)

  /** All after the first `seconds`; of a shorter flight, the whole. */
  case After(seconds: Double)

  /** Instants of it; never empty. */
  def of(tracks: Tracks): Option[Range] = this match
    case Whole          => Some(tracks.instants)
    case After(seconds) =>
      val settled = tracks.instants.dropWhile(tracks.timeS(_) < seconds)
      Some(if settled.isEmpty then tracks.instants else settled)
    case Last(seconds) =>
      val many = (seconds / tracks.stepS).toInt
      Option.when(tracks.instants.size >= 0.95 * many)(
        tracks.instants.drop(tracks.instants.size - 1 - many max 0)
      )
