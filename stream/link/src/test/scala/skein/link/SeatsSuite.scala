package skein.link

import skein.units.{Clock, Instant}

class SeatsSuite extends munit.FunSuite:
  private var now          = 0.0
  private val clock: Clock = () => Instant.ofNanos((now * 1e9).round)

  test("a connection without a message makes room, the earliest first, and is notified once"):
    val seats = Seats(2, clock)
    var told  = Vector.empty[Int]
    for guest <- 1 to 4 do assert(seats.enter(() => told :+= guest).isDefined, guest)
    assertEquals(told, Vector(1, 2))
    assertEquals(seats.displacedConnections, 2L)

  test("a connection silent after its first message makes room after five seconds, and not before"):
    now = 100
    val seats = Seats(1, clock)
    var told  = 0
    val first = seats.enter(() => told += 1).get
    first.spoke()
    now = 104.9
    assert(seats.enter(() => fail("never had a seat")).isEmpty)
    now = 105
    assert(seats.enter(() => ()).isDefined)
    assertEquals((told, seats.displacedConnections, seats.refusedConnections), (1, 1L, 1L))

  test("an active connection keeps its seat, however many arrive"):
    now = 0
    val seats = Seats(2, clock)
    val first = seats.enter(() => fail("it speaks")).get
    for second <- 1 to 100 do
      now = second
      first.spoke()
      seats.enter(() => ()): Unit
    first.left()

  test("returned seats are free"):
    val seats = Seats(1, clock)
    for _ <- 1 to 10 do
      val one = seats.enter(() => ()).get
      one.spoke()
      one.left()
