package skein.report

import skein.figures.ObservedFigure
import skein.observe.{LoopAccount, Observed, Passed, SimulatedTime, TopicAccount}
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
      """atS,vehicle,method,connection,ownAgeMs,othersAgeMs,boundMs,sinceOwnMs,sinceOthersMs,unanswered
        |0.020000,A,hover,0,15.000,,5.000,,,1
        |0.120000,A,hover,0,115.000,,5.000,100.000,,2
        |""".stripMargin
    )

  test("a name with a comma or a quotation mark remains one cell"):
    assert(ObservedTables.csv(observed("A, \"B\"").log).contains("0.020000,\"A, \"\"B\"\"\",hover,"))

  test("the figure has a bar for each vehicle that was commanded, and there is none without"):
    assert(ObservedFigure(observed("A").vehicles).exists(_.shapes.nonEmpty))
    assertEquals(ObservedFigure(LoopAccount().observed.vehicles), None)

  test("progress names the ages of a few vehicles, and the greatest of many"):
    def line(vehicles: Int) =
      val account = LoopAccount()
      for index <- 0 until vehicles do
        account.add(Passed.Called(0, 3 * index, "getMultirotorState", s"v$index", at(0)))
        account.add(Passed.Answered(0, 3 * index, None, None, 500, at(0)))
        account.add(Passed.Called(0, 3 * index + 1, "hover", s"v$index", at(20 + index)))
      ObservedTables.line(account.progress)
    assertEquals(line(0), None)
    assertEquals(line(1), Some("0 s: 1 commands, data 20 ms old"))
    assertEquals(line(2), Some("0 s: 2 commands, data of v0 20, v1 21 ms old"))
    assertEquals(line(5), Some("0 s: 5 commands, data of 5 vehicles up to 24 ms old"))

  test("tables of topics state by which clock the loop is measured, and scripts get its findings as a table"):
    val account = TopicAccount()
    account.reading("a", "/a/odom", Some(at(0)), at(5))
    account.command("a", "/a/cmd_vel", None, at(20))
    val observed = account.observed
    assert(TopicTables.findings(
      observed
    ).contains("Times are by the clock of the machine that received the messages."))
    val simulated = observed.copy(simulated = Some(SimulatedTime(Span.ofMillis(20), before = 3)))
    val findings  = TopicTables.findings(simulated)
    assert(
      findings.contains(
        "Times are simulated, by /clock: known to within its step of 20 ms. 3 messages from before it began are " +
          "not counted."
      ),
      findings
    )
    assertEquals(TopicTables.data(simulated, findings).last.table.map(_.rows), Some(findings.map(Vector(_))))
