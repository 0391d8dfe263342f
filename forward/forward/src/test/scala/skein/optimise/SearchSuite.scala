package skein.optimise

import skein.policy.{Axis, SearchSpace}
import skein.signal.SplitMix64

class SearchSuite extends munit.FunSuite:
  private val space = SearchSpace(Vector(Axis("a", -2, 4), Axis("b", -3, 3)))

  private def depth(c: Vector[Double]): Double = math.pow(c(0) - 1, 2) + 2 * math.pow(c(1) + 0.5, 2)

  /** A bowl with its minimum at (1, −0.5). Its episodes are noisy, and the noise is nearly equal for all
    * candidates.
    */
  private val bowl: Evaluator = (candidates, episodes) =>
    candidates.map: c =>
      RunningStats.of(episodes.size): i =>
        depth(c) + 0.1 * (SplitMix64(episodes(i) * 31L + c.hashCode).nextDouble() - 0.5)

  private val hill: Evaluator = (candidates, episodes) =>
    bowl.tallies(candidates, episodes).map(tally => tally.copy(mean = -tally.mean))

  private val methods = Vector(
    SearchMethod.Grid(25, 4),
    SearchMethod.Random(900, 4),
    SearchMethod.CrossEntropy(60, 15, 4),
    SearchMethod.CmaEs(12, 60, 4),
    SearchMethod.Racing(400, 2)
  )

  private def search(method: SearchMethod, seed: Long = 3) =
    Search.run(space, method, Direction.Minimise, seed, bowl)

  test("a grid spans the space, bounds included"):
    val grid = space.grid(4)
    assertEquals(grid.size, 16)
    assertEquals(grid.head, Vector(-2.0, -3.0))
    assertEquals(grid.last, Vector(4.0, 3.0))
    assertEquals(grid(1), Vector(-2.0, -1.0))

  test("random candidates are within the space, and equal seeds draw equal candidates"):
    val drawn = space.random(500, 7)
    assert(drawn.forall(c => space.clamp(c) == c))
    assertEquals(space.random(500, 7), drawn)
    assertNotEquals(space.random(500, 8), drawn)

  test("shares outside 0 to 1 are mirrored at the bounds"):
    assertEquals(space.at(Vector(0, 1)), Vector(-2.0, 3.0))
    assertEquals(space.at(Vector(-0.25, 1.5)), space.at(Vector(0.25, 0.5)))
    assertEquals(space.shares(space.at(Vector(0.25, 0.75))), Vector(0.25, 0.75))

  for method <- methods do
    test(s"$method finds the minimum of a noisy bowl, and equal seeds give equal results"):
      val found = search(method).head
      assert(depth(found.candidate) < 0.05, s"seed 3: $found")
      assertEquals(search(method).head, found)

    test(s"$method, maximising, finds the top of a hill"):
      val found = Search.run(space, method, Direction.Maximise, 3, hill).head
      assert(depth(found.candidate) < 0.05, s"seed 3: $found")

    test(s"the result of $method does not depend on its division into steps"):
      val machine                 = Search(space, method, Direction.Minimise, 5)
      def run(atMost: Int => Int) =
        Iterator
          .iterate((machine.start, 0))((state, i) => (machine.step(state, bowl, atMost(i)), i + 1))
          .map(_._1)
          .find(_.isDone)
          .get
      val whole = run(_ => Int.MaxValue)
      assertEquals(run(i => 1 + (i * 37) % 200), whole)

      def cutAndGoneOnWith(state: SearchState) =
        val left = machine.step(state, bowl, 150, isCancelled = () => true)
        assertEquals(left, state)
        machine.step(left, bowl, 150)
      assertEquals(Iterator.iterate(machine.start)(cutAndGoneOnWith).find(_.isDone).get, whole)
      assert(whole.flown <= machine.expected, s"flew ${whole.flown}, expected at most ${machine.expected}")

  test("the play-off uses fresh episodes, on which no candidate was chosen"):
    val seen      = Set.newBuilder[Int]
    val evaluator = new Evaluator:
      def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
        if episodes.head >= Search.PlayOffFrom then seen ++= episodes
        bowl.tallies(candidates, episodes)
    val found = Search.run(space, SearchMethod.Random(200, 4), Direction.Minimise, 1, evaluator).head
    assertEquals(found.tally.count, seen.result().size)

  test("the play-off spends most of its episodes on its two best candidates"):
    val machine  = Search(space, SearchMethod.Random(200, 100), Direction.Minimise, 1)
    val ended    = Iterator.iterate(machine.start)(machine.step(_, bowl, Int.MaxValue)).find(_.isDone).get
    val episodes = ended.leaders.map(_.tally.count)
    assertEquals(episodes.take(2), Vector.fill(2)(episodes.max))
    assertEquals(episodes, episodes.sorted.reverse)
    assert(episodes.last * 8 < episodes.head, s"$episodes")
    assert(ended.flown <= machine.expected && ended.flown > 0.99 * machine.expected, s"$ended")

  test("a race spends most of its episodes on the good candidates"):
    var flown     = Map.empty[Vector[Double], Int].withDefaultValue(0)
    val evaluator = new Evaluator:
      def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
        if episodes.head < Search.PlayOffFrom then
          for c <- candidates do flown = flown.updated(c, flown(c) + episodes.size)
        bowl.tallies(candidates, episodes)
    val _ = Search.run(space, SearchMethod.Racing(64, 2), Direction.Minimise, 5, evaluator)
    assertEquals(
      flown.values.toVector.sorted.groupBy(identity).view.mapValues(_.size).toMap,
      Map(2 -> 32, 4 -> 16, 8 -> 8, 16 -> 4, 32 -> 2, 64 -> 1, 128 -> 1)
    )
    assertEquals(flown.values.map(_.toLong).sum, SearchMethod.Racing(64, 2).evaluations(2))

  test("a candidate whose value is NaN is worse than all others"):
    val holes: Evaluator = (candidates, episodes) =>
      bowl.tallies(candidates, episodes).zip(candidates).map: (tally, c) =>
        if c(0) > 0.5 then tally.copy(mean = Double.NaN) else tally
    val found = Search.run(space, SearchMethod.CmaEs(12, 40, 4), Direction.Minimise, 3, holes).head
    assert(found.candidate(0) <= 0.5 && depth(found.candidate) < 0.4, s"seed 3: $found")

  test("a race whose last candidates would reach the episodes of the play-off is refused"):
    def race(candidates: Int, episodes: Int) =
      Search(space, SearchMethod.Racing(candidates, episodes), Direction.Minimise, 1)
    assertEquals(SearchMethod.Racing(64, 2).mostOfOne, 128L)
    val _ = race(1 << 17, 1 << 7)
    for (candidates, episodes) <- Seq((1 << 17) -> 129, ((1 << 17) + 1) -> 128, 100_000 -> 1_000_000) do
      val mistake = intercept[IllegalArgumentException](race(candidates, episodes))
      assert(mistake.getMessage.contains("expected at most 16777216"), mistake.getMessage)
