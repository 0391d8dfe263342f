package skein.optimise

import skein.scenario.Scenarios

class ScenarioObjectiveSuite extends munit.FunSuite:
  test("every measure of every scenario may be an objective, alone and in a sum"):
    for
      kind    <- Scenarios.ours.kinds
      measure <- kind.standard.measures
      key = ScenarioTerm.keyOf(measure)
      text <- Seq(key, s"2*$key - 0.5*$key")
    do
      val read = Objective.ofScenario(text, kind.standard)
      assert(read.exists(_.measures.forall(_._2.name == measure.name)), s"${kind.name}: $read")

  test("an extreme weight is refused"):
    val kind = Scenarios.ours.kinds.find(_.name == "surround").get
    for weight <- Seq("1e300", "2000000000") do
      assert(
        Objective.ofScenario(s"$weight*off-ring", kind.standard).left.exists(_.contains("a weight")),
        weight
      )
