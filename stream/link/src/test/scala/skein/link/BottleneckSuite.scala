package skein.link

import skein.signal.Bandwidth
import skein.units.*

class BottleneckSuite extends munit.FunSuite:
  // A byte takes 1 µs; the queue takes 40 ms, a piece 5 ms.
  private def line() = Bottleneck(Bandwidth(8_000_000, 40_000))

  private def ms(value: Double): Span = Span.ofMillis(value)

  test("an idle line sends immediately, and a busy line after earlier data"):
    val busy = line()
    assertEquals(busy.send(ms(10), 1000).sentAt, ms(11))
    assertEquals(busy.send(ms(10), 500).sentAt, ms(11.5))
    assertEquals(busy.send(ms(20), 1000).sentAt, ms(21))

  test("there is room until the queue is full, then for one piece each time the line has sent one"):
    val full  = line()
    val rooms = List.fill(10)(full.send(ms(0), full.pieceBytes).roomAt)
    assertEquals(rooms, List.fill(8)(ms(0)) ++ List(ms(5), ms(10)))

  test(
    "a connection with few bytes waits for a full queue and a piece of each other one, not for all their data"
  ):
    val shared = line()
    var greedy = List.fill(3)(ms(0))
    for now <- (0 until 200).map(tick => ms(tick.toDouble)) do
      greedy = greedy.map: room =>
        var next = room
        while next <= now do next = shared.send(now, shared.pieceBytes).roomAt
        next
      val wait = shared.send(now, 1).sentAt - now
      assert(wait <= ms(40 + 3 * 5 + 1), s"${wait.toMillis} ms at ${now.toMillis} ms")
    assert(shared.free(ms(200)) - ms(200) > ms(35))
