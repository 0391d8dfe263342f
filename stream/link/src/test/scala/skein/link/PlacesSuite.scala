package skein.link

import skein.units.*

class PlacesSuite extends munit.FunSuite:
  private final class Guest(val silentFor: Span, val hasSpoken: Boolean = true) extends Places.Guest:
    var left          = false
    def leave(): Unit = left = true

  private def full(silences: Int*): (Places, Seq[Guest]) =
    val places = Places(silences.size, Span.ofSeconds(5))
    val guests = silences.map(seconds => Guest(Span.ofSeconds(seconds)))
    for (guest, i) <- guests.zipWithIndex do
      assert(places.admit())
      places.entered(i, guest)
    (places, guests)

  test("256 silent connections do not exclude a new one, which takes the place of the longest silent"):
    val (places, guests) = full(10 to 265*)
    for i <- 1 to 256 do
      assert(places.admit(), s"newcomer $i")
      assertEquals(guests.filter(_.left).map(_.silentFor.toSeconds.round.toInt), (266 - i to 265).toVector)
    assert(!places.admit(), "those asked to leave are not asked twice, and none else is silent")

  test("a guest with a recent request keeps its place"):
    val (places, guests) = full(0, 4, 3)
    assert(!places.admit())
    assert(guests.forall(!_.left))
    places.left(1)
    assert(places.admit())

  test("returned places are available again"):
    val (places, _) = full(0, 0)
    for _ <- 1 to 100 do
      places.left(0)
      assert(places.admit())
      assert(!places.admit())

  test("the earliest guest that has sent no message makes room, however short its stay"):
    val places = Places(3, Span.ofSeconds(5))
    val spoken = Guest(Span.ofSeconds(100))
    val mute   = Seq.fill(3)(Guest(Span.Zero, hasSpoken = false))
    for (guest, number) <- (spoken +: mute.take(2)).zipWithIndex do
      assert(places.admit())
      places.entered(number, guest)
    assert(places.admit())
    places.entered(3, mute(2))
    assertEquals((spoken +: mute).map(_.left), Seq(false, true, false, false))
    assert(places.admit() && places.admit())
    assertEquals((spoken +: mute).map(_.left), Seq(false, true, true, true))
    assert(places.admit(), "then the one that is silent for longest")
    assert(spoken.left)
