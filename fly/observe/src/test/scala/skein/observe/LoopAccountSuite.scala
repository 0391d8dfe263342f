package skein.observe

import skein.units.*

/** An observer's analysis of passing messages. Times are in milliseconds on the observer's clock. */
class LoopAccountSuite extends munit.FunSuite:

  /** A program on one or several connections, whose messages all pass the observer. */
  private final class Program(offsetMs: Double = 5_000):
    private val account = LoopAccount()
    private var ids     = 0L

    private def at(ms: Double) = Instant.ofNanos((ms * 1e6).round)

    def call(method: String, vehicle: String, sentMs: Double, connection: Int = 0): Long =
      ids += 1
      account.add(Passed.Called(connection, ids, method, vehicle, at(sentMs)))
      ids

    def answer(
        id: Long,
        cameMs: Double,
        sampledMs: Option[Double] = None,
        connection: Int = 0,
        bytes: Long = 500,
        error: Option[String] = None
    ): Unit =
      val stamp = sampledMs.map(ms => at(ms + offsetMs))
      account.add(Passed.Answered(connection, id, error, stamp, bytes, at(cameMs)))

    /** A call with its answer, before anything else passes. */
    def called(
        method: String,
        vehicle: String,
        sentMs: Double,
        cameMs: Double,
        sampledMs: Option[Double] = None,
        bytes: Long = 500
    ): Unit = answer(call(method, vehicle, sentMs), cameMs, sampledMs, bytes = bytes)

    def move(vehicle: String, sentMs: Double, connection: Int = 0): Long =
      call("moveByVelocityZ", vehicle, sentMs, connection)

    def takeNew(): Vector[NewCommands] = account.takeNew()

    def unreadable(connection: Int, ms: Double): Unit =
      account.add(Passed.Unreadable(connection, "no message", at(ms)))
    def closed(ms: Double): Unit = account.add(Passed.Closed(0, at(ms)))
    def observed: Observed       = account.observed
    def found: Set[String]       = Diagnosis.of(observed).map(_.name).toSet
    def vehicle(name: String)    = observed.vehicles.find(_.name == name).get

  test("a hover that is answered before the end of the move that it replaces has overtaken nothing"):
    val program = Program()
    val moved   = program.move("A", 0)
    val hovers  = program.call("hover", "A", 100)
    program.answer(hovers, 102)
    program.answer(moved, 104)
    assertEquals(program.vehicle("A").overtaken, 0L)

  test("a call whose answer can no longer be read is not awaited for ever"):
    val program = Program()
    program.call("simGetImages", "A", 0, connection = 1): Unit
    program.unreadable(1, 20)
    program.called("getMultirotorState", "A", 30, 40, Some(30))
    program.move("A", 50): Unit
    program.called("getMultirotorState", "A", 1000, 1010, Some(1000))
    program.move("A", 1050): Unit
    assertEquals(program.observed.periodMs.getOrElse("images", 0.0), 0.0)

  test("each command is logged with what was known when it passed"):
    val program = Program()
    program.move("A", 0)
    program.called("getMultirotorState", "B", 10, 30, Some(20))
    program.called("getMultirotorState", "A", 40, 60, Some(50))
    program.move("A", 70)
    program.move("B", 75)
    val log = program.observed.log
    assertEquals(log.map(_.vehicle), Vector("A", "A", "B"))
    assertEquals(log.head.ownAgeMs, None)
    assertEquals(log.head.sinceOwnMs, None)
    assertEquals(log(1).sinceOwnMs, Some(70.0))
    assertEquals(log(1).sinceOthersMs, None)
    assertEqualsDouble(log(1).ownAgeMs.get, 20, 1e-6)
    assertEqualsDouble(log(1).othersAgeMs.get, 50, 1e-6)
    assertEquals(log(2).sinceOthersMs, Some(5.0))
    assertEqualsDouble(log(2).at.toMillis, 75, 1e-6)

  test("of commands since the last look, the largest age, interval and number of unanswered calls are kept"):
    val program = Program()
    program.called("getMultirotorState", "A", 0, 20, Some(10))
    program.move("A", 30)
    program.move("B", 35)
    program.move("A", 90)
    assertEquals(
      program.takeNew().map(one => one.copy(ownAgeMs = one.ownAgeMs.map(_.round.toDouble))),
      Vector(NewCommands("A", Some(80.0), Some(60.0), Some(3)), NewCommands("B", None, None, Some(2)))
    )
    assertEquals(program.takeNew(), Vector.empty)

  test("the age of a command's data counts from when it was sampled, by the clocks' offset"):
    val program = Program()
    for tick <- 0 until 50 do
      val ms = tick * 100.0
      program.called("getMultirotorState", "A", ms, ms + 40, Some(ms + 20))
      program.move("A", ms + 50)
    val seen = program.vehicle("A")
    assertEqualsDouble(seen.ownAgeMs.get.mean, 30, 1e-6)
    assertEqualsDouble(seen.boundMs.get, 20, 0.2)
    assertEqualsDouble(seen.everyMs.get.mean, 100, 1e-6)

  test(
    "without time stamps a reading's age is half of its round trip, and the bound states the possible error"
  ):
    val program = Program()
    program.called("simGetVehiclePose", "A", 0, 40)
    program.move("A", 50)
    assertEqualsDouble(program.vehicle("A").ownAgeMs.get.mean, 30, 1e-6)
    assertEqualsDouble(program.vehicle("A").boundMs.get, 20, 1e-6)

  test("reading vehicles one after another is reported as a finding; reading them simultaneously is not"):
    def loop(apart: Double) =
      val program = Program()
      for tick <- 0 until 50 do
        val ms  = tick * 200.0
        val own = program.call("getMultirotorState", "A", ms)
        if apart > 0 then program.answer(own, ms + 40, Some(ms + 20))
        val other = program.call("getMultirotorState", "B", ms + apart)
        if apart == 0 then program.answer(own, ms + 40, Some(ms + 20))
        program.answer(other, ms + apart + 40, Some(ms + apart + 20))
        program.answer(program.move("A", ms + 90), ms + 95)
      program
    assert(loop(apart = 45).found("reads in turn"))
    assertEqualsDouble(loop(apart = 45).vehicle("A").othersAgeMs.get.mean, 25, 0.1)
    assert(!loop(apart = 0).found("reads in turn"))

  test("images between readings and commands are found with the time that they take"):
    val program = Program()
    for tick <- 0 until 20 do
      val ms = tick * 200.0
      program.called("getMultirotorState", "A", ms, ms + 10, Some(ms + 5))
      program.called("simGetImages", "A", ms + 10, ms + 130, bytes = 900_000)
      program.move("A", ms + 140)
    assert(program.found("images in the control loop"))
    assertEqualsDouble(program.observed.periodMs("images"), 120, 1e-6)
    assertEqualsDouble(program.observed.periodMs.values.sum, 200, 1e-6)

  test("a third command while two are unanswered is found"):
    val program = Program()
    for tick <- 0 until 3 do program.move("A", tick * 100.0)
    assertEquals(program.vehicle("A").mostInFlight, 3)
    assert(program.found("many moves unanswered"))

  test("a command that was sent before another and acts after it is found; one that is replaced is not"):
    val inOrder = Program()
    val first   = inOrder.move("A", 0)
    val second  = inOrder.move("A", 100)
    inOrder.answer(first, 140)
    val third = inOrder.move("A", 200)
    inOrder.answer(second, 240)
    inOrder.answer(third, 400)
    assertEquals(inOrder.vehicle("A").overtaken, 0L)
    val crossed = Program()
    val late    = crossed.move("A", 0, connection = 1)
    val early   = crossed.move("A", 10, connection = 2)
    crossed.answer(early, 60, connection = 2)
    crossed.answer(late, 500, connection = 1)
    assertEquals(crossed.vehicle("A").overtaken, 1L)

  test("a program that waits for each move to end is found; one that continues meanwhile is not"):
    def loop(waits: Boolean) =
      val program = Program()
      for tick <- 0 until 10 do
        val ms   = tick * 600.0
        val move = program.move("A", ms)
        if !waits then program.called("getMultirotorState", "A", ms + 10, ms + 50, Some(ms + 30))
        program.answer(move, ms + 500)
      program
    assert(loop(waits = true).found("waits for each move"))
    assert(!loop(waits = false).found("waits for each move"))

  test("small calls that are slow only during an image show that images fill the link"):
    val program = Program()
    for tick <- 0 until 40 do
      val ms = tick * 200.0
      program.called("getMultirotorState", "A", ms, ms + 20, Some(ms + 10))
      val image = program.call("simGetImages", "A", ms + 30, connection = 1)
      program.called("getMultirotorState", "A", ms + 40, ms + 120, Some(ms + 50))
      program.answer(image, ms + 130, connection = 1, bytes = 900_000)
    assert(program.found("images fill the link"))

  test("a link that images fill is found by few slow calls, for a program that waits sends no more of them"):
    val program = Program()
    for tick <- 0 until 20 do
      val ms    = tick * 1_000.0
      val image = program.call("simGetImages", "A", ms, connection = 1)
      // These pass before the image's bytes.
      for call <- 0 to 1 do
        program.called("getMultirotorState", "A", ms + 10 + 30 * call, ms + 30 + 30 * call)
      program.called("getMultirotorState", "A", ms + 80, ms + 400)
      program.answer(image, ms + 410, connection = 1, bytes = 900_000)
      program.called("getMultirotorState", "A", ms + 500, ms + 520)
    assert(program.found("images fill the link"))

  test("a call that takes much longer than its like is a stall, once for all that waited"):
    val program = Program()
    for tick <- 0 until 30 do
      program.called("getMultirotorState", "A", tick * 100.0, tick * 100.0 + 40, Some(tick * 100.0 + 20))
    val waiting = (0 until 3).map(count => program.call("getMultirotorState", "A", 3_000 + 100.0 * count))
    waiting.foreach(program.answer(_, 4_500))
    assertEquals(program.observed.stalls.map(_.length), Vector(Span.ofMillis(1_500)))

  test("a simulator's clock that runs back, and one that stops, are found"):
    val back = Program()
    back.called("getMultirotorState", "A", 0, 40, Some(20))
    back.called("getMultirotorState", "A", 100, 140, Some(-900))
    assertEquals(back.observed.clock.get.backwards, 1L)
    val still = Program()
    for tick <- 0 until 10 do
      still.called("getMultirotorState", "A", tick * 100.0, tick * 100.0 + 40, Some(20))
    assert(still.found("the simulator stands still"))

  test("old time stamps of sensors, scans and contacts do not change the clock"):
    val program = Program()
    for tick <- 0 until 50 do
      val ms = tick * 100.0
      program.called("getMultirotorState", "A", ms, ms + 40, Some(ms + 20))
      program.called("simGetCollisionInfo", "A", ms + 41, ms + 44, Some(-3_000))
      program.called("getGpsData", "A", ms + 45, ms + 48, Some(ms - 200))
      program.move("A", ms + 50)
    assertEqualsDouble(program.vehicle("A").ownAgeMs.get.mean, 30, 1e-6)
    assertEqualsDouble(program.vehicle("A").boundMs.get, 20, 0.2)
    assertEquals(
      program.observed.clock.map(clock => (clock.backwards, clock.stoodStill)),
      Some((0L, Span.Zero))
    )

  test("a reset does not hide that the simulator's clock is slow, as a pause does"):
    def slow(first: String) =
      val program = Program()
      program.called(first, "", 0, 5)
      for tick <- 0 until 10 do
        program.called("getMultirotorState", "A", 100 + tick * 100.0, 140 + tick * 100.0, Some(tick * 50.0))
      program.found("the simulator is not at real time")
    assert(slow("reset"))
    assert(!slow("simPause"))

  test("readings of an object count as others' data only as long as the program keeps requesting them"):
    def others(reads: Int => Boolean) =
      val program = Program()
      for tick <- 0 until 100 do
        val ms = tick * 100.0
        if reads(tick) then program.called("simGetObjectPose", "Goal", ms, ms + 10)
        program.called("getMultirotorState", "A", ms + 10, ms + 30, Some(ms + 20))
        program.answer(program.move("A", ms + 40), ms + 45)
      program.vehicle("A").othersAgeMs.get
    assertEqualsDouble(others(_ == 0).mean, 35, 1e-6)
    assertEquals(others(_ == 0).count, 1)
    assertEqualsDouble(others(_ % 5 == 0).mean, 235, 10)
    assertEquals(others(_ < 10).most.round, 235L)

  test("a period is that of the vehicle with the most commands"):
    val program = Program()
    for tick <- 0 until 101 do
      program.move("A", tick * 100.0)
      if tick % 10 == 0 then program.move("B", tick * 100.0 + 1): Unit
    assertEqualsDouble(program.observed.periodMs.values.sum, 100, 0.1)

  test("a connection that is not understood is reported with its number in the log of commands"):
    val account = LoopAccount()
    account.add(Passed.Unreadable(1, "no MessagePack", Instant.Epoch))
    assertEquals(account.observed.lost, Vector("connection 1: no MessagePack"))

  test("commands that still run when their connection closes are reported"):
    val program = Program()
    program.move("A", 0)
    program.closed(50)
    assertEquals(program.vehicle("A").leftRunning, 1L)
    assert(program.found("moves left running"))

  test("calls that fail are reported with the first reason"):
    val program = Program()
    program.answer(program.call("getMultirotorState", "A", 0), 40, error = Some("no such vehicle"))
    assertEquals(program.observed.methods.map(_.firstError), Vector(Some("no such vehicle")))
    assert(program.found("calls fail"))

  test("a loop without a fault has no finding"):
    val program = Program()
    var before  = Option.empty[Long]
    for tick <- 0 until 100 do
      val ms = tick * 100.0
      program.called("getMultirotorState", "A", ms, ms + 20, Some(ms + 10))
      val move = program.move("A", ms + 25)
      before.foreach(program.answer(_, ms + 30))
      before = Some(move)
    assertEquals(program.found, Set.empty[String])
