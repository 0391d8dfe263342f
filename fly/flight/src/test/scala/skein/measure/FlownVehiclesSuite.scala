package skein.measure

import skein.policy.Action
import skein.record.*
import skein.record.CommandOutcome.*
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** Arrival times of commands, estimated from readings that take 30 ms to the simulator and 10 ms back, every
  * 100 ms for 1 s. The simulator's clock is 1000 s behind. So a command sent at t arrives t after the first
  * reading.
  */
class FlownVehiclesSuite extends munit.FunSuite:
  private val ms    = Span.ofMillis
  private val start = Instant.Epoch + Span.ofSeconds(2000)

  private def heading(loop: String) = RecordingHeader(
    FlightRow(
      "f",
      loop,
      "none",
      1,
      ms(100),
      Span.ofSeconds(1),
      "virtual",
      Simulator.Other(""),
      "duel",
      "",
      start
    ),
    Seq(
      VehicleRow("Red", "pursuer", MetresPerSecond(10), Vector3.Zero),
      VehicleRow("Blue", "evader", MetresPerSecond(5), Vector3.Zero)
    )
  )

  private def readings(vehicle: String) =
    for n <- 0 to 10 yield
      val sent    = start + ms(100.0 * n)
      val sampled = sent + ms(30)
      val state   = Kinematics(Vector3(n, -n, -20), Vector3(10, -10, 0), Quaternion.Identity, Vector3.Zero)
      ReadingRow(n, vehicle, Stamped(state, sampled - Span.ofSeconds(1000), sent, sampled + ms(10)))

  private def command(
      number: Long,
      atMs: Double,
      vehicle: String = "Red",
      decision: Option[Long] = None
  ) = CommandRow(
    number,
    vehicle,
    decision,
    MetresPerSecond(number.toDouble),
    MetresPerSecond(-number.toDouble),
    Metres(-20 - number.toDouble),
    start + ms(atMs)
  )

  private def ended(number: Long, atMs: Double, outcome: CommandOutcome) =
    Acknowledgement("Red", number, start + ms(atMs), outcome)

  private def flown(loop: String, records: Record*) =
    FlownVehicles
      .of(Recording(heading(loop), readings("Red") ++ readings("Blue") ++ records))
      .flatMap(_.stretches)

  private def arrivals(records: Record*): Seq[(Double, Double)] =
    flown("stream", records*).flatMap(_.arrivals).map: command =>
      assertEquals(command.vy, -command.vx)
      (math.round(command.atS * 1e6) / 1e3, command.vx)

  test(
    "a commanded vehicle's history ends when its last command arrives, and other vehicles are left out"
  ):
    val all = flown("stream", command(1, 50), command(2, 450))
    assertEquals(all.map(_.name), Vector("f, Red"))
    assertEquals(all.head.downM, -20.0)
    assertEquals(all.head.arrivals.map(_.atS), Vector(0.05, 0.45))
    assertEquals(all.head.samples.map(sample => math.round(sample.atS * 10).toInt), Vector(0, 1, 2, 3, 4))
    val sample = all.head.samples(3)
    assertEquals((sample.x, sample.y, sample.vx, sample.vy), (3.0, -3.0, 10.0, -10.0))

  test(
    "a command that superseded another arrived in the middle of its round trip's known part"
  ):
    // 60 ms instead of 40: half of it on either way.
    assertEquals(
      arrivals(command(1, 50), command(2, 250), ended(1, 310, Superseded), ended(2, 900, Done)),
      Seq(50.0 -> 1.0, 260.0 -> 2.0)
    )
    // An answer that arrived before the next command left is not caused by it.
    assertEquals(
      arrivals(command(1, 50), command(2, 250), ended(1, 240, Superseded)),
      Seq(50.0 -> 1.0, 250.0 -> 2.0)
    )
    assertEquals(
      arrivals(command(1, 50), command(2, 250), ended(1, 310, Done)),
      Seq(50.0 -> 1.0, 250.0 -> 2.0)
    )

  test("a command whose call failed counts only if it superseded the previous one"):
    assertEquals(
      arrivals(command(1, 50), command(2, 250), ended(1, 300, Done), ended(2, 400, Failed("timed out"))),
      Seq(50.0 -> 1.0)
    )
    assertEquals(
      arrivals(
        command(1, 50),
        command(2, 250),
        ended(1, 290, Superseded),
        ended(2, 400, Failed("timed out"))
      ),
      Seq(50.0 -> 1.0, 250.0 -> 2.0)
    )
    assertEquals(flown("stream", command(1, 50), ended(1, 300, Failed("refused"))), Vector.empty)

  test("no command arrives before one that was sent earlier"):
    // The second was answered late: by its round trip alone it would have arrived 100 ms after the third.
    assertEquals(
      arrivals(command(1, 50), command(2, 250), command(3, 280), ended(1, 550, Superseded)),
      Seq(50.0 -> 1.0, 380.0 -> 2.0, 380.0 -> 3.0)
    )

  test("while the simulator stands still, a command arrives when it is decided"):
    val decided =
      Samples.decision(7).copy(vehicle = "Red", decidedAt = start + ms(530) - Span.ofSeconds(1000))
    val other = decided.copy(vehicle = "Blue", decidedAt = start)
    val all   = flown("paused", decided, other, command(1, 900, decision = Some(7)), command(2, 950))
    assertEquals(all.map(_.arrivals.map(_.atS)), Vector(Vector(0.5)))
    assertEquals(all.head.samples.size, 6)

  test("a pause, and a command that is no velocity, end a stretch; the next one begins at its first command"):
    def stretches(records: Record*) = flown("stream", records*).map: stretch =>
      (stretch.arrivals.map(_.vx), stretch.samples.map(sample => math.round(sample.atS * 10).toInt))
    val commands = Seq(command(1, 50), command(2, 350), command(4, 650), command(5, 950))
    val split    = Vector((Vector(1.0, 2.0), Vector(0, 1, 2, 3)), (Vector(4.0, 5.0), Vector(7, 8, 9)))
    def event(kind: EventKind, atMs: Double) = Event(start + ms(atMs), kind, None, "by the test")
    assertEquals(
      stretches(
        (commands :+ event(EventKind.Paused, 400) :+ command(3, 450) :+ event(EventKind.Continued, 500))*
      ),
      split
    )
    def decided(action: Action) =
      Samples.decision(7).copy(vehicle = "Red", decidedAt = start + ms(430), action = Some(action))
    def with3(action: Action) =
      stretches((commands :+ command(3, 450, decision = Some(7)) :+ decided(action)).sortBy {
        case sent: CommandRow => sent.sequence
        case _                => 0L
      }*)
    assertEquals(with3(Action.Hover), split)
    assertEquals(with3(Action.Velocity(Vector3(3, -3, 1))).map(_._1), Vector(Vector(1.0, 2.0, 3.0, 4.0, 5.0)))

  test("relayed readings do not change when commands arrive"):
    val relayed = readings("Red").map(read =>
      // Blue's controller, the second of two, received them 400 ms later.
      read.copy(
        sequence = 2 * read.sequence + 1,
        state = read.state.copy(receivedAt = read.state.receivedAt + ms(400))
      )
    )
    val own     = readings("Red").map(read => read.copy(sequence = 2 * read.sequence))
    val between = ParameterRow("between", "constant:800ms")
    val told    = heading("stream")
    val flown   = FlownVehicles.of(Recording(
      told.copy(parameters = Seq(between, ParameterRow("decentralised", "true"))),
      own ++ relayed ++ Seq(command(1, 50), command(2, 850), ended(1, 910, Superseded))
    ))
    // 60 ms instead of 40: half of it on either way.
    assertEquals(
      flown.flatMap(_.stretches).flatMap(_.arrivals).map(one => math.round(one.atS * 1e3)),
      Vector(50L, 860L)
    )
