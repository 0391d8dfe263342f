package skein.scenario

import skein.testing.Lengthy

/** Reads a million mutated scenario files; none may cause an exception. */
class ScenarioMutantsSuite extends munit.FunSuite, Lengthy:
  override val munitTimeout: scala.concurrent.duration.Duration =
    scala.concurrent.duration.Duration(1, "hour")

  test("a million mutated files are read, or refused with one line each (seed 11)"):
    val whole = ScenarioMutants.check(ScenarioFileSuite.Patrol, seed = 11, count = 1_000_000)((text, why) =>
      fail(why + "\n" + text)
    )
    assert(whole > 10_000, s"$whole could be read")
