package skein.cli

import skein.report.PaperReport
import skein.scenario.Scenarios
import skein.testing.{TemporaryFolders, Unhurried}

/** Tries a few of the mutants of `tryMutants`. */
class MutatedFilesSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = PaperReport.scenarios

  for kind <- MutatedFiles.values do
    folder.test(s"$kind: a mutated file is read, or its mistakes are reported, one line each"): folder =>
      assert(kind.unchanged(folder).isRight, kind.unchanged(folder))
      val count = if kind == MutatedFiles.Mcap then 10 else 100
      val wrong = (1 to count).flatMap(seed => kind.attempt(seed, folder).wrong)
      assertEquals(wrong, Vector.empty)
