package skein.measure

import skein.record.Recording
import skein.scenario.{Scenario, Scenarios}

/** The scenario of a recorded flight. */
object RecordedScenario:
  def of(recording: Recording)(using scenarios: Scenarios): Either[String, Scenario] =
    scenarios.ofRecording(
      recording.flight.nameOfScenario,
      recording.heading.parameters.map(parameter => parameter.name -> parameter.value).toMap
    )
