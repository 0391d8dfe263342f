package skein.cli

import skein.recognition.BlindPursuit
import skein.report.PaperReport
import skein.scenario.{ScenarioKind, Scenarios}

/** The scenarios of `./skein`: those of the core, the duel with its report, and those whose policies
  * recognise images.
  */
object OurScenarios:
  val all: Scenarios = Scenarios(PaperReport.scenarios.kinds :+ ScenarioKind(BlindPursuit()))
