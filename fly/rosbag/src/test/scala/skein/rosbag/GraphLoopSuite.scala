package skein.rosbag

import scala.collection.mutable
import skein.ros.message.*
import skein.ros.{Qos, RosGraph}
import skein.units.{Expect, Instant, Span}

/** The loop of a graph without a middleware. Times are in milliseconds; arrivals are on the observer's clock.
  */
class GraphLoopSuite extends munit.FunSuite:
  private val zero  = Vector3(0, 0, 0)
  private val twist = Twist(zero, zero)

  private def at(ms: Double) = Instant.ofNanos((ms * 1e6).round + 1_000_000_000_000L)

  private final class Graph(readings: Set[String] = Set.empty, commands: Set[String] = Set.empty)
      extends RosGraph:
    private val receivers = mutable.LinkedHashMap.empty[String, (Array[Byte], Instant) => Unit]

    var absent      = Set.empty[String]
    var definitions = Map.empty[String, String]
    var refused     = 0L
    var lost        = 0L
    var notes       = Vector.empty[String]
    val qualities   = mutable.Set.empty[Qos]

    def subscribeRaw(topic: String, kind: String, qos: Qos, most: Int)(
        receive: (Array[Byte], Instant) => Unit
    ): Either[String, Unit] =
      assert(!receivers.contains(topic), topic)
      assertEquals(most, 12)
      qualities += qos
      Expect.that(!absent(kind))(s"expected $kind").map: _ =>
        receivers(topic) = (bytes, arrived) => receive(bytes.take(most), arrived)

    def definition(kind: String): String = definitions.getOrElse(kind, "")
    def close(): Unit                    = ()

    val loop = GraphLoop(readings, commands, this)

    def topics(all: (String, String)*): Unit =
      loop.topics(all.toVector.map((name, kind) => name -> Vector(kind)))

    def subscribed: Vector[String] = receivers.keysIterator.toVector

    def send[A](topic: String, ms: Double, value: A)(using kind: MessageType[A]): Unit =
      receivers.get(topic).foreach(_(Cdr.bytes(value)(using kind.cdr), at(ms)))

    def reading(vehicle: String, stampMs: Double, ms: Double): Unit =
      val pose = Pose(Point(0, 0, 0), Quaternion(0, 0, 0, 1))
      send(
        s"/$vehicle/odom",
        ms,
        Odometry(
          Header(Time.of(at(stampMs)), "map"),
          "base",
          PoseWithCovariance(pose, Doubles.zero),
          TwistWithCovariance(twist, Doubles.zero)
        )
      )

    def command(vehicle: String, ms: Double, stampMs: Double): Unit =
      send(s"/$vehicle/cmd_vel", ms, TwistStamped(Header(Time.of(at(stampMs)), ""), twist))

    def ages: Vector[Double] =
      loop.close()
      loop.observed.log.flatMap(_.ownAgeMs)

  private val (odometry, stamped) = ("nav_msgs/msg/Odometry", "geometry_msgs/msg/TwistStamped")

  private def usual(graph: Graph): Unit = graph.topics("/a/odom" -> odometry, "/a/cmd_vel" -> stamped)

  test("topics of poses and commands are found by type and name, also if they appear later"):
    val graph = Graph()
    graph.topics("/rosout" -> "rcl_interfaces/msg/Log", "/a/odom" -> odometry)
    graph.topics("/a/odom" -> odometry, "/a/goal" -> "geometry_msgs/msg/PoseStamped", "/a/speed" -> stamped)
    assertEquals(graph.subscribed, Vector("/a/odom", "/a/goal"))
    assertEquals(graph.qualities.toSet, Set(Qos(isReliable = false, depth = 64)))

  test("of a topic's several types, the useful one is taken"):
    val graph = Graph()
    graph.loop.topics(Vector("/a/cmd_vel" -> Vector("std_msgs/msg/String", stamped)))
    assertEquals(graph.subscribed, Vector("/a/cmd_vel"))

  test("a command with a reading's stamp was caused by it; for any other, the newest reading is assumed"):
    val graph = Graph()
    usual(graph)
    graph.reading("a", 0, 2)
    graph.reading("a", 20, 22)
    graph.command("a", ms = 50, stampMs = 0)
    graph.command("a", ms = 60, stampMs = 55)
    assertEquals(graph.ages, Vector(50.0, 40.0))
    assertEquals(graph.loop.observed.caused, 1L)

  test("the age of a reading without a stamp counts from its arrival"):
    val graph = Graph()
    usual(graph)
    graph.reading("a", -1_000_000, 20)
    graph.command("a", ms = 50, stampMs = 50)
    assertEquals(graph.ages, Vector(30.0))

  test("messages delivered topic by topic are counted in the order of their arrival"):
    val graph = Graph()
    usual(graph)
    graph.reading("a", 0, 2)
    graph.reading("a", 20, 22)
    graph.command("a", ms = 10, stampMs = 10)
    graph.loop.upTo(at(22))
    assertEquals(graph.ages, Vector(10.0))

  test("with /clock, ages and times are simulated, at any speed; earlier messages are only counted"):
    val graph = Graph()
    usual(graph)
    graph.topics("/clock" -> "rosgraph_msgs/msg/Clock")
    graph.reading("a", 0, 2)
    // Ten times as fast: a message every 2 ms, of 20 simulated ms.
    for tick <- 0 to 100 do
      val simulated = -900_000 + 20.0 * tick
      if tick % 5 == 0 then graph.reading("a", simulated, 1000 + 2 * tick - 0.1)
      if tick == 53 then graph.command("a", ms = 1000 + 2 * tick + 1, stampMs = -900_000 + 20.0 * 50)
      graph.send("/clock", 1000 + 2 * tick, Clock(Time.of(at(simulated))))
    val Vector(age) = graph.ages: @unchecked
    // From tick 50 to 53, and half a step.
    assertEqualsDouble(age, 70, 20)
    val observed = graph.loop.observed
    assertEquals(observed.simulated.map(_.step), Some(Span.ofMillis(20)))
    assertEquals(observed.simulated.map(_.before), Some(2L))
    assertEquals((observed.caused, observed.byOtherClock), (1L, Vector.empty))
    assertEqualsDouble(observed.topics.head.intervalMs.get.median, 100, 20)

  test("with /clock, a stamp that a node may have read from it identifies no reading"):
    val graph = Graph()
    usual(graph)
    graph.topics("/clock" -> "rosgraph_msgs/msg/Clock")
    for tick <- 0 to 50 do
      graph.reading("a", 20.0 * tick, 20 * tick - 0.1)
      graph.send("/clock", 20 * tick, Clock(Time.of(at(20.0 * tick))))
    graph.command("a", ms = 1_001, stampMs = 1_000)
    graph.command("a", ms = 1_002, stampMs = 900)
    val Vector(now, old) = graph.ages: @unchecked
    assertEqualsDouble(now, 1, 0.2)
    assertEqualsDouble(old, 102, 0.2)
    assertEquals(graph.loop.observed.caused, 1L)

  test("a type's definition shows whether it begins with a header"):
    val definitions = Seq("uint64 at\nstd_msgs/Header header\n" -> 30.0, "# Of.\nstd_msgs/Header h\n" -> 50.0)
    for (definition, age) <- definitions do
      val graph = Graph(readings = Set("/a/state"))
      graph.definitions = Map("own_msgs/msg/State" -> definition)
      graph.topics("/a/state" -> "own_msgs/msg/State", "/a/cmd_vel" -> stamped)
      // Any message serves whose first bytes are a time.
      graph.send("/a/state", 20, Clock(Time.of(at(0))))
      graph.command("a", ms = 50, stampMs = 50)
      assertEquals(graph.ages, Vector(age))

  test("a topic that did not appear, a missing package, and too many topics are reported"):
    val graph = Graph(readings = Set("/x/odom"))
    graph.absent = Set(stamped)
    graph.refused = 3
    graph.lost = 4
    graph.notes = Vector("/b/odom: refused a message: why")
    graph.topics(Vector.tabulate(300)(index => s"/v$index/cmd_vel" -> stamped)*)
    assertEquals(graph.loop.remarks.size, 6)
    val all = graph.loop.remarks.mkString("\n")
    for line <- Seq(
        "The topic /x/odom did not appear; the graph has /v0/cmd_vel, ",
        "/v11/cmd_vel, 288 more.",
        "expected geometry_msgs/msg/TwistStamped.",
        "/b/odom: refused a message: why.",
        "44 topics beyond the first 256 were not observed.",
        "3 messages were refused.",
        "4 messages were lost on their way to the observer: gaps may be its own."
      )
    do assert(all.contains(line), s"$line\n${all.takeRight(600)}")
