package skein.measure

import skein.units.Decimals.{brief, counted}

/** Distinguishes flights of one name, so that unlike flights are neither averaged nor shown as one. */
private[measure] object FlightNames:
  private val MostLetters = 24

  /** An option in which flights of one loop may differ.
    *
    * @param noun stands for a long value, with a number
    * @param of its value in words, empty if it is the usual; None if it does not count
    */
  private final case class Named(noun: String, of: FlightSummary => Option[String])

  /** Options of a loop. Flights that differ in one of them are not averaged. */
  private val options: Vector[Named] = Vector(
    Named("model", one => Some(one.predictor.getOrElse(""))),
    Named("", one => Some(one.movesInFlight.fold("")(moves => s"${counted(moves, "move")} in flight"))),
    Named("", one => Some(s"every ${one.flight.period.toMillis.brief} ms")),
    Named("", one => Some(s"for ${one.flight.duration.toSeconds.brief} s")),
    // Flights in virtual time have the built-in simulator, whatever their live twins have.
    Named("simulator", one => Option.unless(one.flight.isVirtual)(one.flight.simulator.label))
  ) ++ FlightOptions.inWords.map((name, words) =>
    Named(name, one => Some(one.options.collectFirst { case (`name`, value) => words(value) }.getOrElse("")))
  )

  /** Adds to the names the options in which flights of one name, scenario and link differ. */
  def apart(flights: Vector[FlightSummary]): Vector[FlightSummary] =
    def kind(one: FlightSummary) = (one.flownAs, one.flight.link, one.flight.scenario, one.scenario)
    val values                   = flights
      .groupBy(kind)
      .map((kind, alike) => kind -> options.map(option => alike.flatMap(option.of).distinct))
    flights.map: one =>
      val words = options.zip(values(kind(one))).flatMap: (option, all) =>
        option.of(one).filter(value => value.nonEmpty && all.sizeIs > 1).map: value =>
          if value.length <= MostLetters then value
          else s"${option.noun} ${all.filter(_.nonEmpty).indexOf(value) + 1}"
      if words.isEmpty then one else one.copy(apart = words.map(", " + _).mkString)
