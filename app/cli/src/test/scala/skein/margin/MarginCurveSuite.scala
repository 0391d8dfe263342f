package skein.margin

import skein.budget.Tolerance
import skein.optimise.LatencyBudget.Bound
import skein.signal.LatencyProfile

class MarginCurveSuite extends munit.FunSuite:
  import MarginRun.NoResult

  private def link(ms: Int) = LatencyProfile.parse(s"constant:${ms}ms", Left(_)).toOption.get

  private def run(value: Either[NoResult, Double]) = MarginRun(value, 0, None, None)

  private def point(ms: Int, values: Double*) =
    MarginPoint(if ms == 0 then LatencyProfile.none else link(ms), values.map(v => run(Right(v))).toVector)

  private def failing(ms: Int, why: NoResult) = MarginPoint(link(ms), Vector(run(Left(why)), run(Left(why))))

  private def curve(reference: MarginPoint, points: MarginPoint*) =
    MarginCurve.of(MarginJudge.Printed, Tolerance.Share(0.05), reference, points.toVector)

  private val reference = point(0, 100, 100, 100)

  test(
    "the margin is interpolated between the links around the tolerance, in any order of the links"
  ):
    val flown = curve(reference, point(100, 110, 110), point(50, 102, 102)).toOption.get
    // From 2 % at 50 ms to 10 % at 100 ms.
    assertEquals(flown.margin, Bound.At(50 + 50 * 3.0 / 8))
    assertEquals(flown.interval, (from = Bound.At(68.75), to = Bound.At(68.75)))

  test("a result that decreases leaves the tolerance, too"):
    assertEquals(curve(reference, point(100, 90, 90)).toOption.get.margin, Bound.At(50))

  test("if a result stays within the tolerance, the margin is beyond the longest measured round trip"):
    val flown = curve(reference, point(100, 101, 101)).toOption.get
    assertEquals(flown.margin, Bound.Beyond(100))
    assert(flown.sentence.contains("as far as it was flown, to a mean round trip of 100 ms"), flown.sentence)

  test("scattered runs make the interval wide, and two runs make it wider than four of equal spread"):
    def width(values: Double*) =
      curve(point(0, 99, 101, 99, 101), point(100, values*)).toOption.get.interval match
        case (from = Bound.At(from), to = Bound.At(to)) => to - from
        case (from = Bound.At(_), to = Bound.Beyond(_)) => Double.PositiveInfinity
        case other                                      => fail(s"$other")
    assert(width(108, 112, 108, 112) > 5)
    assert(width(108, 112) > width(108, 112, 108, 112))

  test("with a single run of each link, the margin has no interval"):
    val flown = curve(point(0, 100), point(100, 110)).toOption.get
    assertEquals(flown.margin, Bound.At(50))
    assertEquals(flown.interval, (from = Bound.At(0), to = Bound.Beyond(100)))
    assert(MarginTables.remarks(flown, 1).exists(_.contains("--repeats")))

  test("a link over which the program fails ends the margin at the previous link"):
    val dies = failing(80, NoResult.OfProgram("it ended with exit status 1"))
    assertEquals(curve(reference, point(40, 101, 101), dies).toOption.get.margin, Bound.At(40))

  test("a link over which the program fails in half of the runs does so, too; fewer failures are stated"):
    def some(failures: Int) =
      val runs = Vector.fill(failures)(run(Left(NoResult.OfProgram("exit 1")))) ++ Vector.fill(5 - failures)(
        run(Right(101))
      )
      curve(reference, point(40, 101, 101), MarginPoint(link(80), runs)).toOption.get
    assertEquals(some(3).margin, Bound.At(40))
    assertEquals(some(2).margin, Bound.Beyond(80))
    assert(clue(some(2).sentence).endsWith("; the program failed in 2 of 5 runs at 80 ms"))

  test("a link whose runs were spoiled by the machine is ignored"):
    val busy  = failing(80, NoResult.OfMachine("too busy"))
    val flown = curve(reference, point(40, 101, 101), busy, point(120, 101, 101)).toOption.get
    assertEquals(flown.margin, Bound.Beyond(120))
    val remark = MarginTables.remarks(flown, 1).find(_.contains("too busy"))
    assert(remark.exists(_.contains("2 of 9 runs")), remark)

  test("without a result of the reference, one line states why there is no curve"):
    val spoilt = MarginPoint(LatencyProfile.none, Vector(run(Left(NoResult.OfMachine("too busy")))))
    assertEquals(
      curve(spoilt, point(50, 1)).left.toOption,
      Some("no run without a link has a result, to compare with: too busy")
    )
    val zero = curve(point(0, 0, 0), point(50, 1)).left.toOption
    assert(zero.exists(_.contains("--within")), zero)

  test(
    "tables have a row for each link and the failures with reasons, and figures show what was measured"
  ):
    val dies     = failing(80, NoResult.OfProgram("it hung"))
    val flown    = curve(reference, point(40, 101, 103), dies).toOption.get
    val sections = MarginTables.of(flown, hasLimits = true)
    assertEquals(sections.map(_.title), Vector("Over each link", "Margin", "Runs without a result"))
    assertEquals(sections.head.table.get.rows.map(_.head), Vector("none", "constant:40ms", "constant:80ms"))
    assertEquals(sections.last.table.get.rows, Vector(Vector("constant:80ms", "2", "it hung")))
    assert(MarginFigure(flown).shapes.nonEmpty)
    assert(MarginFigure(curve(point(0, 5), dies).toOption.get).shapes.nonEmpty)
