package skein.measure

import skein.units.Decimals.{brief, counted}

/** Distinguishes flights of one name, so that unlike flights are neither averaged nor shown as one. */
private[measure] object FlightNames:
  private val MostLetters = 24

  /** Options of a loop in words. Flights that differ in one of them are not averaged. */
  private val options: Vector[FlightSummary => Option[String]] = Vector(
    _.predictor,
    _.movesInFlight.map(moves => s"${counted(moves, "move")} in flight"),
    one => Some(s"every ${one.flight.period.toMillis.brief} ms"),
    one => Some(s"for ${one.flight.duration.toSeconds.brief} s")
  )

  /** Adds to the names the options in which flights of one name, scenario and link differ. */
  def apart(flights: Vector[FlightSummary]): Vector[FlightSummary] =
    def kind(one: FlightSummary) = (one.flownAs, one.flight.link, one.flight.scenario, one.scenario)
    val values                   =
      flights.groupBy(kind).map((kind, alike) => kind -> options.map(option => alike.map(option).distinct))
    flights.map: one =>
      val words = options.zip(values(kind(one))).flatMap: (option, all) =>
        option(one).filter(_ => all.sizeIs > 1).map: value =>
          if value.length > MostLetters then s"model ${all.indexOf(Some(value)) + 1}" else value
      if words.isEmpty then one else one.copy(apart = words.map(", " + _).mkString)
