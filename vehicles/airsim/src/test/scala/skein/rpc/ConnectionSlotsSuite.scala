package skein.rpc

import skein.units.*

class ConnectionSlotsSuite extends munit.FunSuite:
  private final class Guest(val silentFor: Span) extends ConnectionSlots.Guest:
    var left          = false
    def leave(): Unit = left = true

  private def full(silences: Int*): (ConnectionSlots, Seq[Guest]) =
    val places = ConnectionSlots(silences.size, Span.ofSeconds(5))
    val guests = silences.map(seconds => Guest(Span.ofSeconds(seconds)))
    for (guest, i) <- guests.zipWithIndex do
      assert(places.admit())
      places.entered(i, guest)
    (places, guests)

  test(
    "256 silent connections lock nobody out: each that comes takes the place of the one silent for longest"
  ):
    val (places, guests) = full(10 to 265*)
    for i <- 1 to 256 do
      assert(places.admit(), s"newcomer $i")
      assertEquals(guests.filter(_.left).map(_.silentFor.toSeconds.round.toInt), (266 - i to 265).toVector)
    assert(!places.admit(), "those asked to leave are not asked twice, and none else is silent")

  test("nobody who has just asked something has to leave"):
    val (places, guests) = full(0, 4, 3)
    assert(!places.admit())
    assert(guests.forall(!_.left))
    places.left(1)
    assert(places.admit())

  test("places given back are given again"):
    val (places, _) = full(0, 0)
    for _ <- 1 to 100 do
      places.left(0)
      assert(places.admit())
      assert(!places.admit())
