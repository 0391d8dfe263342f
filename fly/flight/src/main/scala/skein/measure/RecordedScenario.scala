package skein.measure

import skein.record.Recording
import skein.scenario.{Scenario, Scenarios}

/** The scenario that a recording says was flown. */
object RecordedScenario:
  /** @return or why it is not known here */
  def of(recording: Recording)(using scenarios: Scenarios): Either[String, Scenario] =
    scenarios.ofRecording(
      recording.flight.nameOfScenario,
      recording.heading.parameters.map(parameter => parameter.name -> parameter.value).toMap
    )
