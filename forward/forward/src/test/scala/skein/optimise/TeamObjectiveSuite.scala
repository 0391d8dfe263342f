package skein.optimise

import skein.scenario.Scenarios

class TeamObjectiveSuite extends munit.FunSuite:
  test("every measure of every scenario can be named as an objective, alone and in a sum"):
    for
      kind    <- Scenarios.ours.kinds
      measure <- kind.standard.measures
      key = TeamObjective.keyOf(measure)
      text <- Seq(key, s"2*$key - 0.5*$key")
    do
      val read = TeamObjective.ofAll(text, kind.standard)
      assert(read.exists(_.measures.forall(_.name == measure.name)), s"${kind.name}: $read")

  test("a weight that is out of all proportion is refused"):
    val kind = Scenarios.ours.kinds.find(_.name == "surround").get
    for weight <- Seq("1e300", "2000000000") do
      assert(
        TeamObjective.ofAll(s"$weight*off-ring", kind.standard).left.exists(_.contains("a weight")),
        weight
      )
