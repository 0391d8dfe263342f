package skein.lanes

import java.nio.file.{Files, Path}
import skein.forward.DelayTable
import skein.testing.Unhurried

/** The code in the guide on formulas compiles and runs. */
class GuideSuite extends munit.FunSuite, Unhurried:
  private val root =
    Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at => Files.exists(at.resolve("sbtw"))).get
  private val guide = Files.readString(root.resolve("docs/guides/formulas.md"))
  private val shown =
    val source =
      Files.readString(root.resolve("forward/forward/src/test/scala/skein/lanes/GuideExample.scala"))
    source.split(
      "// guide: (?!end)"
    ).drop(1).map(_.split("// guide: end")(0).linesIterator.drop(1).mkString("\n").stripTrailing.stripIndent)

  test("the guide contains the example's code, word by word"):
    for part <- shown do assert(guide.contains(part), part)

  test("a SIMD search of the example's policy finds one that is better than the default"):
    import GuideExample.*
    val engine =
      TeamBatch(timing, lag).engine(candidate(leads.space.defaults), true, Seq(DelayTable.vpn)).text
    assert(engine.startsWith("SIMD"), engine)
    val middle = evaluator.tallies(Vector(leads.space.defaults), 0 until 20).head.mean
    assert(best._2.mean < middle, s"${best._2.mean} against $middle")
