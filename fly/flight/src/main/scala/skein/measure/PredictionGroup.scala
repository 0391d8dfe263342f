package skein.measure

/** The prediction errors of all flights of one loop over one link. */
final case class PredictionGroup(name: String, link: String, own: PredictionErrors, others: PredictionErrors)

object PredictionGroup:

  def of(flights: Seq[FlightSummary]): Vector[PredictionGroup] =
    val predicted = flights.toVector.filter(_.predictions.nonEmpty)
    for
      key <- predicted.map(one => (one.name, one.flight.link)).distinct
      group  = predicted.filter(one => (one.name, one.flight.link) == key)
      errors = group.flatMap(_.predictions)
    yield PredictionGroup(
      key._1,
      key._2,
      errors.map(_.own).reduce(_ ++ _),
      errors.map(_.others).reduce(_ ++ _)
    )
