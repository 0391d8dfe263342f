package skein.units

import java.io.FileNotFoundException

class OwnFailureSuite extends munit.FunSuite:

  private def told(mistake: => Throwable): String =
    intercept[OwnFailure](OwnFailure.told("the policy of Scout")(throw mistake)).getMessage

  test("every exception is reported with its origin, checked exceptions too"):
    val mistakes = Vector[() => Throwable](
      () => Exception("no luck"),
      () => FileNotFoundException("corners.csv"),
      () => IllegalStateException(),
      () => StackOverflowError()
    )
    for mistake <- mistakes do
      assert(
        clue(told(mistake())).startsWith(s"the policy of Scout failed: ${mistake()} (OwnFailureSuite.scala:")
      )

  test("the text of a failure is its message, without the class name"):
    assertEquals(
      s"${OwnFailure("the policy of Scout", "answered null")}",
      "the policy of Scout answered null"
    )

  test("exhausted memory and interrupts are rethrown unchanged"):
    for asItIs <- Seq(OutOfMemoryError(), InterruptedException()) do
      val thrown =
        try OwnFailure.told("it")(throw asItIs)
        catch case thrown: Throwable => thrown
      assert(thrown eq asItIs)

  test("the reported line is in the user's code, not in a library or in Skein's code"):
    def thrown(classes: String*) =
      val mistake = IllegalStateException("bad")
      val frames  = (classes :+ OwnFailure.getClass.getName).zipWithIndex.map: (name, line) =>
        StackTraceElement(name, "called", s"${name.split('.').last}.scala", line)
      mistake.setStackTrace(frames.toArray)
      told(mistake)
    def line(classes: String*) =
      thrown(classes*).stripPrefix("the policy of Scout failed: java.lang.IllegalStateException: bad ")
    assertEquals(line("patrol.Scout", "skein.loop.Decider"), "(Scout.scala:0)")
    assertEquals(
      line("java.util.Map", "skein.units.Span", "patrol.Scout", "skein.loop.Decider"),
      "(Scout.scala:2)"
    )
    assertEquals(
      line("org.other.Parser", "patrol.maps.Corners", "patrol.Scout", "skein.policy.HeadingPolicy"),
      "(Corners.scala:1)"
    )
    assertEquals(line("scala.Option", "skein.scenario.Forest", "skein.loop.Decider"), "(Forest.scala:1)")

  test("a failed class initialisation is reported by its cause"):
    assert(clue(told(ExceptionInInitializerError(IllegalStateException("no map")))).startsWith(
      "the policy of Scout failed: java.lang.IllegalStateException: no map"
    ))
