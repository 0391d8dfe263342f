package skein.cli

/** `./skein`: the paper's duel, surround, formation, crossing, forest, convoy, shadow and blind-pursuit. */
object Main extends SkeinApp(OurScenarios.all.kinds*)
