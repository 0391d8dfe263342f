package skein.search

import org.scalacheck.{Arbitrary, Gen, Prop}
import scala.collection.immutable.ArraySeq
import skein.optimise.ValueEvaluator
import skein.testing.Optimised

class SearchBlockLaws extends munit.ScalaCheckSuite, Optimised:
  /** Values whose sums depend on their order. */
  private object Rough extends ValueEvaluator:
    def valuesUnless(isCancelled: () => Boolean)(candidates: Vector[Vector[Double]], episodes: Range) =
      Some(candidates.map(candidate =>
        episodes.map(episode => math.sin(candidate.sum * 1e3 + episode) * math.pow(10, episode % 17)).toArray
      ))

  private val calls =
    for
      axes       <- Gen.choose(0, 5)
      candidates <- Gen.choose(1, 80)
      values     <- Gen.listOfN(axes * candidates, Gen.choose(-9.0, 9.0))
      from       <- Gen.choose(0, 1 << 24)
      episodes   <- Gen.choose(1, 200)
      atMost     <- Gen.choose(1, 3000)
      judge      <- Gen.oneOf(Judge.values.toSeq)
    yield (
      judge,
      if axes == 0 then Vector.fill(candidates)(Vector.empty[Double])
      else values.toVector.grouped(axes).toVector,
      from until from + episodes,
      atMost
    )

  property("for any division of a call, the combined answers equal the undivided call's, to the bit"):
    Prop.forAll(calls): (judge, candidates, episodes, atMost) =>
      val blocks  = SearchBlock.cut(judge, candidates, episodes, atMost)
      val answers = blocks.map(block => SearchBlock.read(block.bytes).fold(fail(_), _.answer(_ => Rough)))
      assertEquals(
        SearchBlock.together(blocks, answers, episodes.size),
        Right(Rough.tallies(candidates, episodes))
      )

  property("only a block of one candidate and one episode may exceed the bound"):
    Prop.forAll(calls): (judge, candidates, episodes, atMost) =>
      for block <- SearchBlock.cut(judge, candidates, episodes, atMost) do
        assert(block.candidates.size * block.episodes.size <= atMost)

  property("a block is read back as it was written"):
    Prop.forAll(calls): (judge, candidates, episodes, atMost) =>
      for block <- SearchBlock.cut(judge, candidates, episodes, atMost) do
        assertEquals(SearchBlock.read(block.bytes), Right(block))

  property("for any bytes, an invalid block is refused in a line"):
    Prop.forAll(Gen.listOf(Arbitrary.arbitrary[Byte])): bytes =>
      val read = SearchBlock.read(ArraySeq.from(bytes))
      for block <- read do assertEquals(block.bytes.size, bytes.size)

  test("an answer of another length is refused"):
    val blocks = SearchBlock.cut(Judge.Winner, Vector(Vector(1.0)), 0 until 4, 100)
    assert(SearchBlock.together(blocks, Vector(ArraySeq.fill(3)(0)), 4).isLeft)
