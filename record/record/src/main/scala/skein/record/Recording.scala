package skein.record

/** A recorded flight, sorted by kind; each kind in the order in which it was recorded. */
final case class Recording(
    heading: RecordingHeader,
    readings: Vector[ReadingRow] = Vector.empty,
    decisions: Vector[DecisionRow] = Vector.empty,
    sightings: Vector[Sighting] = Vector.empty,
    measurements: Vector[MeasurementRow] = Vector.empty,
    sensings: Vector[Sensing] = Vector.empty,
    planned: Vector[Planned] = Vector.empty,
    solved: Vector[SolvedRow] = Vector.empty,
    predictions: Vector[Prediction] = Vector.empty,
    commands: Vector[CommandRow] = Vector.empty,
    acknowledgements: Vector[Acknowledgement] = Vector.empty,
    latencies: Vector[Latency] = Vector.empty,
    events: Vector[Event] = Vector.empty,
    truths: Vector[Truth] = Vector.empty,
    ending: Option[Ending] = None
):
  def flight: FlightRow = heading.flight

object Recording:

  /** A recording of these records. Parameters recorded during the flight are added to the header's, as when a
    * file is read.
    */
  def apply(heading: RecordingHeader, records: Seq[Record]): Recording =
    Recording(
      heading.copy(parameters = heading.parameters ++ records.collect { case parameter: ParameterRow =>
        parameter
      }),
      records.collect { case reading: ReadingRow => reading }.toVector,
      records.collect { case decision: DecisionRow => decision }.toVector,
      records.collect { case sighting: Sighting => sighting }.toVector,
      records.collect { case measurement: MeasurementRow => measurement }.toVector,
      records.collect { case sensing: Sensing => sensing }.toVector,
      records.collect { case planned: Planned => planned }.toVector,
      records.collect { case solved: SolvedRow => solved }.toVector,
      records.collect { case prediction: Prediction => prediction }.toVector,
      records.collect { case command: CommandRow => command }.toVector,
      records.collect { case acknowledgement: Acknowledgement => acknowledgement }.toVector,
      records.collect { case latency: Latency => latency }.toVector,
      records.collect { case event: Event => event }.toVector,
      records.collect { case truth: Truth => truth }.toVector,
      records.collectFirst { case ending: Ending => ending }
    )
