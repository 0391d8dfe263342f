package skein.cli

import mainargs.ParserForClass

class TortureCommandSuite extends munit.FunSuite:

  test("the command that repeats a flight names files as they were typed, in a shell's quotation marks"):
    val words =
      Seq("--duration", "1 min", "--scenario", "my flights/patrol.scenario", "--scene", "hill's.scene")
    assertEquals(
      TortureCommand.again(ParserForClass[TortureOptions].constructOrThrow(words), seed = 7),
      "./skein torture --first 7 --seeds 1 --duration '1 min' --scenario 'my flights/patrol.scenario' " +
        "--scene 'hill'\\''s.scene'"
    )
