package skein.cli

import mainargs.ParserForClass

class ArgumentsSuite extends munit.FunSuite:

  private val options = ParserForClass[LearnOptions].constructOrThrow(
    "--resume here --steps 7 --turn-rate 2 --plant drag --workers 2 --json".split(' ').toSeq
  )

  test("given options are recognised by their flags, also in groups of options"):
    assertEquals(
      Arguments.told(options),
      Set("--resume", "--steps", "--turn-rate", "--plant", "--workers", "--json")
    )
    assertEquals(Arguments.told(ParserForClass[LearnOptions].constructOrThrow(Nil)), Set.empty)

  test("when a folder is continued, other given options are listed"):
    val may = Arguments.told(options.cluster) + "--json"
    assertEquals(
      Arguments.resumed(options, may, "--threads"),
      Left(
        "--resume: everything but --threads is taken from the folder; " +
          "expected no other option, got --plant, --steps, --turn-rate"
      )
    )
    assertEquals(Arguments.resumed(options.cluster, may, "--threads"), Right(()))
