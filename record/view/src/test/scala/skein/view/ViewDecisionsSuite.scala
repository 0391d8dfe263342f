package skein.view

import skein.record.{Event, LaterRow}
import skein.record.EventKind
import skein.units.Instant

class ViewDecisionsSuite extends munit.FunSuite:

  test("a subscription must name an existing channel, once, and within the limit"):
    val none = Subscriptions.none(ViewerLimits(subscriptions = 2), Set(1, 2))
    val two  = none.added(10, 1).flatMap(_.added(11, 1)).toOption.get
    assertEquals(two.of(1).toSet, Set(10L, 11L))
    assertEquals(two.of(2).toSet, Set.empty[Long])
    assertEquals(none.added(10, 3), Left("there is no channel 3"))
    assertEquals(two.added(10, 2), Left("there is a subscription 10 already"))
    assertEquals(two.added(12, 2), Left("a viewer has at most 2 subscriptions"))
    assertEquals(two.removed(12).map(_ => ()), Left("there is no subscription 12"))
    assertEquals(two.removed(10).map(_.of(1).toSet), Right(Set(11L)))

  test("a feed without a reader keeps the newest records, and counts the others"):
    val feed           = Feed(capacity = 3)
    def event(at: Int) = Event(Instant.ofNanos(at), EventKind.Dropped, None, "")
    (1 to 5).foreach(at => feed.offer(event(at)))
    assertEquals(Vector.unfold(())(_ => feed.poll().map((_, ()))), Vector(3, 4, 5).map(event))
    assertEquals(feed.lost, 2L)
    var made = 0
    feed.offer(LaterRow { made += 1; event(6) })
    assertEquals(made, 0)
    assertEquals((feed.poll(), made), (Some(event(6)), 1))

  test("a token accepts only its own word, and every drawn token differs"):
    val token = Token("right")
    for (said, isRight) <-
        Seq("right" -> true, "wrong" -> false, "righ" -> false, "right " -> false, "" -> false)
    do assertEquals(token.is(said), isRight, said)
    val drawn = Seq.fill(100)(Token.drawn().word)
    assertEquals(drawn.distinct.size, 100)
    assert(drawn.forall(_.matches("[0-9a-f]{16}")), drawn.head)
