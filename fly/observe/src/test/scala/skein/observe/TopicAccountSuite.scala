package skein.observe

import skein.units.*

/** Times are in milliseconds: of messages on the recorder's clock, of stamps on the vehicles'. */
class TopicAccountSuite extends munit.FunSuite:

  private final class Graph(offsetMs: Double = 0):
    private val account = TopicAccount()

    private def at(ms: Double) = Instant.ofNanos((ms * 1e6).round + 1_000_000_000_000L)

    def reading(vehicle: String, stampMs: Double, cameMs: Double): Unit =
      account.reading(vehicle, s"/$vehicle/odom", Some(at(stampMs + offsetMs)), at(cameMs))

    def command(vehicle: String, sentMs: Double, stampMs: Option[Double] = None): Unit =
      account.command(vehicle, s"/$vehicle/cmd_vel", stampMs.map(ms => at(ms + offsetMs)), at(sentMs))

    def observed: ObservedTopics     = account.observed
    def ages: Vector[Option[Double]] = observed.log.map(_.ownAgeMs)

  test("a command is based on the newest reading before it"):
    val graph = Graph()
    graph.command("a", 0)
    graph.reading("a", 10, 30)
    graph.reading("a", 20, 45)
    graph.command("a", 50)
    graph.command("a", 60)
    assertEquals(graph.ages, Vector(None, Some(30.0), Some(40.0)))
    assertEquals(graph.observed.log.map(_.sinceOwnMs), Vector(None, Some(50.0), Some(10.0)))
    assertEquals(graph.observed.caused, 0L)

  test("a command with the stamp of an older reading is based on that one"):
    val graph = Graph()
    graph.reading("a", 10, 30)
    graph.reading("a", 20, 45)
    graph.command("a", 50, Some(10))
    graph.command("a", 60, Some(11))
    assertEquals(graph.ages, Vector(Some(40.0), Some(40.0)))
    assertEquals(graph.observed.caused, 1L)

  test("an overtaken message is not a newer reading, and is counted"):
    val graph = Graph()
    graph.reading("a", 20, 30)
    graph.reading("a", 10, 40)
    graph.command("a", 50)
    assertEquals(graph.ages, Vector(Some(30.0)))
    assertEquals(graph.observed.topics.head.backwards, 1L)

  test("the age of the other vehicles' data is that of the oldest of their newest readings"):
    val graph = Graph()
    graph.reading("a", 10, 20)
    graph.reading("b", 5, 21)
    graph.reading("c", 8, 22)
    graph.command("a", 30)
    graph.command("b", 34)
    val Vector(first, second) = graph.observed.log.take(2): @unchecked
    assertEquals(first.othersAgeMs, Some(25.0))
    assertEquals(second.sinceOthersMs, Some(4.0))

  test("with stamps of simulated time, ages are relative to the fastest message's latency"):
    val graph = Graph(offsetMs = -900_000)
    graph.reading("a", 10, 30)
    graph.reading("a", 60, 65)
    graph.reading("a", 110, 140)
    graph.command("a", 150)
    // The fastest message took 5 ms.
    assertEquals(graph.ages, Vector(Some(35.0)))
    assertEquals(graph.observed.byOtherClock, Vector("a"))
    assertEquals(graph.observed.topics.head.lateMs, None)

  test("gaps are intervals longer than two and a half usual ones"):
    val graph = Graph()
    for (ms, _) <- Vector(0, 20, 40, 60, 115, 135, 155).zipWithIndex do graph.reading("a", ms, ms + 3)
    val topic = graph.observed.topics.head
    assertEquals((topic.messages, topic.gaps), (7L, 1L))
    assertEqualsDouble(topic.lateMs.get.mean, 3, 1e-9)

  test("messages of vehicles beyond the limit are counted, but not kept"):
    val graph = Graph()
    for number <- 0 until 300 do graph.reading(s"v$number", number, number)
    assertEquals((graph.observed.vehicles.size, graph.observed.notKept), (256, 44L))
