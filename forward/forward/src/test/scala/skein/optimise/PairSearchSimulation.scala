package skein.optimise

import java.util.concurrent.atomic.AtomicInteger
import skein.forward.{DelayTable, LoopTiming, Pair, ScoredRollout, VelocityResponses}
import skein.lanes.{TeamBatch, TeamCandidate}
import skein.policy.{PaperPursuer, PolicyFamily, Role}
import skein.simd.WorldRandom
import skein.testing.Unhurried

class PairSearchSimulation extends munit.FunSuite, Unhurried:
  private val lag   = VelocityResponses.lag(0.9, 0.8, 0.05)
  private val short = Pair.paper.copy(durationS = 15)

  private val nearest = Objective(Vector(1.0 -> DistanceTerm.Last10s), Direction.Minimise)

  private def game(threads: Int): Evaluator = TeamEvaluator(
    TeamBatch(LoopTiming.Stream(), lag, threads),
    parameters =>
      val team = short.engagement.flownBy(Role.Pursuer, PolicyFamily.paperPursuer.policy(parameters))
      TeamCandidate(team, nearest.judged(15, 0.1))
    ,
    DelayTable.vpn,
    nearest,
    seed = 1,
    usual = PolicyFamily.paperPursuer.space.defaults
  )

  test(
    "a turn rate's mean distance agrees with the scalar reference, with any number of threads"
  ):
    val candidates = Vector(Vector(0.7), Vector(1.0), Vector(1.4))
    val tallies    = game(1).tallies(candidates, 0 until 30)
    assertEquals(game(2).tallies(candidates, 0 until 30), tallies)
    for (tally, candidate) <- tallies.zip(candidates) do
      val pursuer = short.pursuer.copy(policy = PaperPursuer(candidate.head.toFloat))
      val rollout =
        ScoredRollout(short.copy(pursuer = pursuer).engagement, LoopTiming.Stream(), DelayTable.vpn, lag)
      val reference = (0 until 30).map(episode => rollout.fly(WorldRandom.key(1, 0, episode)).meanLast10sM)
      assertEqualsDouble(tally.mean, reference.sum / 30, 0.03)

  test(
    "over vpn, the search finds a turn rate for the paper's pursuer at least as good as any of a fine grid"
  ):
    val turnRate  = PolicyFamily.paperPursuer.space
    val evaluator = game(1)
    val grid      = Search.run(turnRate, SearchMethod.Grid(29, 20), Direction.Minimise, 1, evaluator).head
    val found = Search.run(turnRate, SearchMethod.CmaEs(10, 12, 20), Direction.Minimise, 1, evaluator).head
    assert(found.tally.mean <= grid.tally.mean + 0.02, s"$found, grid $grid")

  test("a cancelled simulation of candidates ends within its batches and returns nothing"):
    val asked      = AtomicInteger()
    val candidates = Vector.fill(400)(PolicyFamily.paperPursuer.space.defaults)
    assertEquals(game(1).talliesUnless(() => asked.incrementAndGet() > 2)(candidates, 0 until 4), None)
    assert(asked.get <= 4, s"asked ${asked.get} times")
