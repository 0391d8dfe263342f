package skein.rollout

import skein.policy.{Axis, PaperPursuer, SearchSpace}
import skein.signal.SplitMix64

class SearchSuite extends munit.FunSuite:
  private val space = SearchSpace(Vector(Axis("a", -2, 4), Axis("b", -3, 3)))

  /** A bowl around (1, -0.5) whose episodes are noisy, all candidates alike but for a little of their own. */
  private val bowl: Objective = (candidates, episodes) =>
    candidates.map: c =>
      val noise = episodes.map(e => SplitMix64(e * 31L + c.hashCode).nextDouble() - 0.5).sum / episodes.size
      math.pow(c(0) - 1, 2) + 2 * math.pow(c(1) + 0.5, 2) + 0.1 * noise

  private val turnRate = SearchSpace(Vector(Axis("turnRate", 0.3, 2.5)))

  private def game(threads: Int) = TurnRateObjective(
    Duel.paper.copy(durationS = 30),
    LoopTiming.Stream(),
    DelayTable.vpn,
    Reduced(0.9, 0.8, 0.05),
    threads = threads
  )

  test("a grid spans the space, bounds included"):
    val grid = space.grid(4)
    assertEquals(grid.size, 16)
    assertEquals(grid.head, Vector(-2.0, -3.0))
    assertEquals(grid.last, Vector(4.0, 3.0))
    assertEquals(grid(1), Vector(-2.0, -1.0))

  test("random candidates lie in the space, and the same seed draws the same"):
    val drawn = space.random(500, 7)
    assert(drawn.forall(c => space.clamp(c) == c))
    assertEquals(space.random(500, 7), drawn)
    assertNotEquals(space.random(500, 8), drawn)

  test("the cross-entropy method finds the bottom of a noisy bowl, the same for the same seed"):
    def search(seed: Long) = Search.crossEntropy(bowl, space, 60, 25, 4, seed)
    val found              = search(3)
    assertEqualsDouble(found.candidate(0), 1, 0.15)
    assertEqualsDouble(found.candidate(1), -0.5, 0.15)
    assertEquals(search(3), found)

  test("successive halving keeps a good candidate and spends most episodes on the good ones"):
    val candidates = space.random(64, 5)
    val ranked     = Search.halving(bowl, candidates, 2)
    assertEquals(ranked.size, 64)
    assertEquals(ranked.map(_.candidate).toSet, candidates.toSet)
    val truth = candidates.map(c => math.pow(c(0) - 1, 2) + 2 * math.pow(c(1) + 0.5, 2)).sorted
    val won   = ranked.head.candidate
    assert(math.pow(won(0) - 1, 2) + 2 * math.pow(won(1) + 0.5, 2) <= truth(3))
    assertEquals(ranked.head.episodes, 128)
    assertEquals(ranked.map(_.episodes).sum, 32 * 2 + 16 * 4 + 8 * 8 + 4 * 16 + 2 * 32 + 64 + 128)

  test("the value of a turn rate is the scalar reference's mean, and does not depend on the threads"):
    val candidates = Vector(Vector(0.7), Vector(1.0), Vector(1.4))
    val values     = game(1).values(candidates, 0 until 50)
    assertEquals(game(2).values(candidates, 0 until 50), values)
    for (candidate, value) <- candidates.zip(values) do
      val duel = Duel.paper.copy(
        pursuer = Duel.paper.pursuer.copy(policy = PaperPursuer(candidate.head.toFloat)),
        durationS = 30
      )
      val rollout = Rollout(duel, LoopTiming.Stream(), DelayTable.vpn, Reduced(0.9, 0.8, 0.05))
      val scalar  = (0 until 50).map(e => rollout.fly(WorldRandom.key(1, 0, e)).meanLast10sM).sum / 50
      assertEqualsDouble(value, scalar, 0.03)

  test("the paper's pursuer over vpn: the search finds a turn rate at least as good as any of a fine grid"):
    val objective = game(1)
    val grid      = Search.all(objective, turnRate.grid(23), 20).head
    val found     = Search.crossEntropy(objective, turnRate, 30, 8, 20, seed = 1)
    assert(found.value <= grid.value + 0.02, s"$found, grid $grid")
