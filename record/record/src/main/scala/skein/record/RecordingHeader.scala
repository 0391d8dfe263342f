package skein.record

/** The first records of a recording, which are on disk before any other record is accepted. */
final case class RecordingHeader(
    flight: FlightRow,
    vehicles: Seq[VehicleRow],
    parameters: Seq[ParameterRow] = Nil
):
  def records: Seq[Record] = flight +: (vehicles ++ parameters)

  /** The value of a parameter, if the recording has it. */
  def parameter(name: String): Option[String] = parameters.find(_.name == name).map(_.value)

  /** The values of the parameters whose names begin with `word` and a full stop, by the rest of the name. */
  def parametersOf(word: String): Map[String, String] =
    parameters
      .collect { case ParameterRow(s"$before.$name", value) if before == word => name -> value }
      .toMap
