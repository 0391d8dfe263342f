package skein.report

import skein.figures.ObservedFigure
import skein.observe.{LoopAccount, Observed, Passed}
import skein.units.*

class ObservedTablesSuite extends munit.FunSuite:
  private def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)

  private def observed(vehicle: String): Observed =
    val account = LoopAccount()
    account.add(Passed.Called(0, 1, "getMultirotorState", vehicle, at(0)))
    account.add(Passed.Answered(0, 1, None, None, 500, at(10)))
    account.add(Passed.Called(0, 2, "hover", vehicle, at(20)))
    account.add(Passed.Called(0, 3, "hover", vehicle, at(120)))
    account.observed

  test("each command is a row of comma-separated values, with empty cells for what is unknown"):
    assertEquals(
      ObservedTables.csv(observed("A").log),
      """atS,vehicle,method,connection,ownAgeMs,othersAgeMs,boundMs,sinceOwnMs,sinceOthersMs
        |0.020000,A,hover,0,15.000,,5.000,,
        |0.120000,A,hover,0,115.000,,5.000,100.000,
        |""".stripMargin
    )

  test("a name with a comma or a quotation mark stays one cell"):
    assert(ObservedTables.csv(observed("A, \"B\"").log).contains("0.020000,\"A, \"\"B\"\"\",hover,"))

  test("the figure has a bar for each vehicle that was commanded, and there is none without"):
    assert(ObservedFigure(observed("A").vehicles).exists(_.shapes.nonEmpty))
    assertEquals(ObservedFigure(LoopAccount().observed.vehicles), None)
