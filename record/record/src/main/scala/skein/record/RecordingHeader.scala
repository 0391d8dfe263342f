package skein.record

/** The first records of a recording; on disk before any other is taken. */
final case class RecordingHeader(
    flight: FlightRow,
    vehicles: Seq[VehicleRow],
    parameters: Seq[ParameterRow] = Nil
):
  def records: Seq[Record] = flight +: (vehicles ++ parameters)

  /** The value of a parameter, if the recording has it. */
  def parameter(name: String): Option[String] = parameters.find(_.name == name).map(_.value)

  /** The parameters whose names begin with a word and a full stop, by what follows. */
  def parametersOf(word: String): Map[String, String] =
    parameters
      .collect { case ParameterRow(s"$before.$name", value) if before == word => name -> value }
      .toMap
