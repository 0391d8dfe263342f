package skein.signal

import org.scalacheck.Gen
import org.scalacheck.Prop.forAll
import skein.signal.NewestBounds.{Bounds, Memory}
import skein.units.*

class NewestBoundsLaws extends munit.ScalaCheckSuite:

  /** Numbers with few different values, so that many are equal, and more of them than are stored. */
  private val all =
    Gen.choose(1, 2 * Memory).flatMap(n =>
      Gen.listOfN(n, Gen.zip(Gen.choose(-40, 40), Gen.choose(0, 1000)))
    )

  property("the quartiles are those of the newest bounds, sorted"):
    forAll(all): legs =>
      val bounds = legs.map((lower, upper) => Bounds(Span.ofNanos(lower), Span.ofNanos(upper)))
      val newest = bounds.takeRight(Memory)
      val kept   = bounds.tail.foldLeft(NewestBounds.of(bounds.head))(_.updated(_))
      val at     = (newest.size - 1) / 4
      assertEquals(kept.quartileTo, newest.map(-_.lower.toNanos).sorted.apply(at))
      assertEquals(kept.quartileFrom, newest.map(_.upper.toNanos).sorted.apply(at))
