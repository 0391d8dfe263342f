package skein.link

import skein.units.{Clock, Instant}

class SeatsSuite extends munit.FunSuite:
  private var now          = 0.0
  private val clock: Clock = () => Instant.ofNanos((now * 1e9).round)

  test("who has said nothing makes room, the first who came before all others, and is told once"):
    val seats = Seats(2, clock)
    var told  = Vector.empty[Int]
    for guest <- 1 to 4 do assert(seats.enter(() => told :+= guest).isDefined, guest)
    assertEquals(told, Vector(1, 2))
    assertEquals(seats.displacedConnections, 2L)

  test("who said one word and is silent makes room after five seconds, and before that nobody does"):
    now = 0
    val seats = Seats(1, clock)
    var told  = 0
    val first = seats.enter(() => told += 1).get
    first.spoke()
    now = 4.9
    assert(seats.enter(() => fail("never had a seat")).isEmpty)
    now = 5
    assert(seats.enter(() => ()).isDefined)
    assertEquals((told, seats.displacedConnections, seats.refusedConnections), (1, 1L, 1L))

  test("who speaks keeps its seat, however many come"):
    now = 0
    val seats = Seats(2, clock)
    val first = seats.enter(() => fail("it speaks")).get
    for second <- 1 to 100 do
      now = second
      first.spoke()
      seats.enter(() => ()): Unit
    first.left()

  test("seats given back are free"):
    val seats = Seats(1, clock)
    for _ <- 1 to 10 do
      val one = seats.enter(() => ()).get
      one.spoke()
      one.left()
    assertEquals(seats.taken, 0)
