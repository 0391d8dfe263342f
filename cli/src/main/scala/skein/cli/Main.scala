package skein.cli

import skein.report.DuelReport

/** `./skein`: the paper's duel, surround, formation, crossing and forest. */
object Main extends SkeinApp(DuelReport.scenarios.kinds*)
