package skein.link

import skein.units.Instant

class PlacesSuite extends munit.FunSuite:
  private def at(seconds: Double) = Instant.ofNanos((seconds * 1e9).round)

  private def full(most: Int): Places[Int] =
    (0 until most).foldLeft(Places.of[Int](most)): (places, guest) =>
      places.entered(guest, at(0)) match
        case Places.Entry.Free(after) => after
        case other                    => fail(s"$guest: $other")

  private def gone(places: Places[Int], seconds: Double): Option[Int] = places.entered(99, at(seconds)) match
    case Places.Entry.InPlaceOf(other, after) =>
      assert(after.guests.contains(99) && !after.guests.contains(other))
      assertEquals(after.guests.size, places.most)
      Some(other)
    case Places.Entry.Full()  => None
    case Places.Entry.Free(_) => fail("it was full")

  test("who says nothing for a second makes room, the first who came before all others"):
    val places = full(2).left(0).entered(2, at(0.5)) match
      case Places.Entry.Free(after) => after
      case other                    => fail(s"$other")
    assertEquals(gone(places, 0.9), None)
    assertEquals(gone(places, 1.0), Some(1))
    assertEquals(gone(places.spoke(1, at(0.6)), 1.5), Some(2))

  test("who said one word and is silent makes room after five seconds, and before that nobody does"):
    val places = full(2).spoke(0, at(1)).spoke(1, at(0.5))
    assertEquals(gone(places, 5.4), None)
    assertEquals(gone(places, 5.5), Some(1))
    assertEquals(gone(places.spoke(1, at(5)), 5.9), None)
    assertEquals(gone(places.spoke(1, at(5)), 6), Some(0))

  test("those who have never spoken go before those who have, however long these have been silent"):
    assertEquals(gone(full(3).spoke(0, at(0)).spoke(2, at(0)), 1000), Some(1))

  test("who speaks keeps its place however many come"):
    val speaking = (1 to 100).foldLeft(full(2)): (places, second) =>
      places.spoke(0, at(second)).entered(second + 10, at(second)) match
        case Places.Entry.InPlaceOf(_, after) => after
        case _                                => places
    assert(speaking.guests.contains(0))

  test("who has left, or was displaced, gets no place by speaking"):
    assertEquals(full(1).left(0).spoke(0, at(1)).guests.size, 0)

  test("a seat's connection is told once to leave, and what was refused or displaced is counted"):
    var now   = 0.0
    val seats = Seats(1, () => at(now))
    var told  = 0
    val first = seats.enter(() => told += 1).get
    assert(seats.enter(() => fail("never had a seat")).isEmpty)
    now = 1
    val second = seats.enter(() => fail("nobody came")).get
    assertEquals((told, seats.displacedConnections, seats.refusedConnections), (1, 1L, 1L))
    first.left()
    assertEquals(seats.taken, 1)
    second.left()
    assertEquals(seats.taken, 0)
