package skein.cli

import skein.report.DuelReport

/** `./skein`: the paper's duel, surround, formation and crossing. */
object Main extends SkeinApp(DuelReport.scenarios.kinds*)
