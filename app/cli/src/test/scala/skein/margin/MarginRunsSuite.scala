package skein.margin

import java.util.concurrent.ConcurrentLinkedQueue
import scala.jdk.CollectionConverters.*
import skein.margin.MarginRun.NoResult
import skein.margin.MarginRuns.Outcome
import skein.signal.LatencyProfile

class MarginRunsSuite extends munit.FunSuite:
  private val links = Vector(LatencyProfile.none, LatencyProfile.direct)

  private def ended(value: Either[NoResult, Double], isCut: Boolean = false) =
    Outcome(MarginRun(value, 0, None, None), "", isCut)

  /** The points of runs that end so, one after the other, and the lines about them.
    *
    * @param stopAfter number of runs after which no further one begins
    */
  private def fly(stopAfter: Int = 100)(run: Int => Either[String, Outcome]) =
    var begun = 0
    val lines = ConcurrentLinkedQueue[String]()
    val runs  = MarginRuns(
      (_, _) => { begun += 1; run(begun - 1) },
      MarginJudge.Printed,
      repeats = 2,
      atOnce = 1,
      seed = 1,
      () => begun >= stopAfter,
      lines.add(_): Unit
    )
    val flown = runs.fly(links)
    (points = flown.map(_.points.map(_.runs.map(_.value))), lines = lines.asScala.toVector)

  test("runs that were cut short are left out, whether they have a value or not; failures before are kept"):
    val dies   = NoResult.OfProgram("it died")
    val values = Vector(ended(Right(1)), ended(Left(dies)), ended(Right(3), isCut = true))
    val flown  = fly(stopAfter = 3)(number => Right(values(number)))
    assertEquals(flown.points, Right(Vector(Vector(Right(1.0)), Vector(Left(dies)))))
    assertEquals(flown.lines.size, 2)
    val killed = fly(stopAfter = 1)(_ => Right(ended(Left(dies), isCut = true)))
    assertEquals(killed.points, Right(Vector(Vector.empty, Vector.empty)))

  test("a later run that cannot start has no result, and the other runs keep their results"):
    val flown = fly(): number =>
      if number == 1 then Left("no port")
      else if number == 2 then throw IllegalStateException("no answer")
      else Right(ended(Right(number)))
    def not(why: String) = Left(NoResult.OfMachine(s"it could not be run: $why"))
    assertEquals(
      flown.points,
      Right(Vector(Vector(Right(0.0), not("no answer")), Vector(not("no port"), Right(3.0))))
    )

  test("if the program fails in the first run, no other follows"):
    assertEquals(fly()(_ => Left("cannot start x")).points, Left("cannot start x"))
    assertEquals(
      fly()(_ => Right(ended(Left(NoResult.OfProgram("it died"))))).points,
      Left("without a link: it died")
    )
