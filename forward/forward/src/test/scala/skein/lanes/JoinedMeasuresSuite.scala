package skein.lanes

import skein.forward.*
import skein.lanes.score.Judged
import skein.optimise.{Direction, Objective}
import skein.scenario.{Crossing, Positions, Quantity, Reduction, Scenario, Separation, Surround}
import skein.simd.WorldRandom
import skein.testing.Optimised

/** Measures that join the reductions of several quantities, with SIMD and by the scalar reference. */
class JoinedMeasuresSuite extends munit.FunSuite, Optimised:
  private val lag = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private def objective(text: String, scenario: Scenario) =
    Objective.ofQuantities(text, scenario, Direction.Minimise).fold(why => fail(why), identity)

  private def worlds(number: Int, team: TeamCandidate) = new TeamWorlds:
    def size: Int                            = number
    override def shareEpisodes: Boolean      = true
    def key(world: Int): Int                 = WorldRandom.key(5, 0, world)
    def link(world: Int): Delays             = DelayTable.vpn
    def candidate(world: Int): TeamCandidate = team

  // Narrow lanes and a small margin: some vehicles come too near, and not all are there by the end.
  private val narrow = Crossing(4, entryM = 12, laneM = 0.5, marginM = 0.1, horizonS = 0.5)

  test("all measures of crossing fly with SIMD, as by the scalar reference"):
    val durationS = 7.0
    val batch     = TeamBatch(LoopTiming.Stream(), lag, 1)
    val scalar    = ScalarTeam(LoopTiming.Stream(), lag)
    for key <- Objective.measures(narrow).keys do
      val by     = objective(key, narrow)
      val team   = TeamCandidate(Engagement.of(narrow.fleet, durationS), by.judged(durationS, 0.1))
      val all    = worlds(8, team)
      val engine = batch.engine(team, shareEpisodes = true, Seq(DelayTable.vpn)).text
      assert(engine.startsWith("SIMD"), s"$key: $engine")
      val outcomes = batch.fly(all)
      val truths   = TeamOutcomes(Vector.fill(team.judged.size)(Array.ofDim[Float](all.size)))
      val values   = Vector.tabulate(all.size): world =>
        truths.set(world, scalar.fly(team, DelayTable.vpn, all.key(world)))
        val value = by.value(outcomes, world, durationS)
        assertEqualsDouble(value, by.value(truths, world, durationS), 2e-2, s"$key, world $world")
        value
      assert(values.exists(value => value > 0 && value < Objective.Never), s"$key: $values")

  test("reductions with two accumulators are right in functions so long that they are split"):
    val judged =
      for
        thanM     <- Vector.tabulate(12)(1 + 0.1 * _)
        reduction <- Seq(Reduction.LeastAt, Reduction.MostAt, Reduction.Sd, Reduction.Entries)
      yield Judged(Nearer(thanM), reduction, 0)
    val team     = TeamCandidate(Engagement.of(Surround(6).fleet, 8), judged)
    val all      = worlds(4, team)
    val outcomes = TeamBatch(LoopTiming.Stream(), lag, 1).fly(all)
    for world <- 0 until all.size do
      val truth = ScalarTeam(LoopTiming.Stream(), lag).fly(team, DelayTable.vpn, all.key(world))
      for (value, number) <- truth.zipWithIndex do
        assertEqualsDouble(
          outcomes.values(number)(world),
          value,
          2e-3,
          s"world $world, ${team.quantities(number)}"
        )
      assert(truth.last > 0, truth.toString)

  test("a flight without an arrival counts as worse than any other"):
    for (text, never) <- Seq("to-goal" -> 1e6, "maximise to-goal" -> -1e6) do
      val by   = objective(text, narrow)
      val team = TeamCandidate(Engagement.of(narrow.fleet, 1), by.judged(1, 0.1))
      assertEquals(by.value(TeamBatch(LoopTiming.Stream(), lag, 1).fly(worlds(1, team)), 0, 1), never)

/** By how much two vehicles are nearer to one another than a distance, m. */
private final case class Nearer(thanM: Double) extends Quantity:
  def of(positions: Positions): Double = thanM - Separation.of(positions)
