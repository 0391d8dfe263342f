package skein.signal

import skein.units.*

/** Tests readings of vehicles, ten a second for half a minute, over a link of 20 to 120 ms. */
class TimeAxisSuite extends munit.FunSuite:

  private val random = java.util.Random(5)

  /** Readings of the vehicles.
    *
    * @param clockS a vehicle's clock, s, as a function of the controller's, s
    */
  private def readings(
      lastsS: Double = 30,
      vehicles: Seq[String] = Seq("a", "b")
  )(clockS: (String, Double) => Double): Vector[(String, Stamped[Unit])] =
    for
      tick    <- (0 until (lastsS * 10).toInt).toVector
      vehicle <- vehicles
    yield
      val sentS         = 1000 + tick * 0.1
      val sampledS      = sentS + 0.01 + 0.05 * random.nextDouble
      val cameS         = sampledS + 0.01 + 0.05 * random.nextDouble
      def at(s: Double) = Instant.Epoch + Span.ofSeconds(s)
      (vehicle, Stamped((), at(clockS(vehicle, sampledS - 1000)), at(sentS), at(cameS)))

  private def fault(readings: Vector[(String, Stamped[Unit])]) = TimeAxis.fault(readings.iterator)

  private def assertFault(readings: Vector[(String, Stamped[Unit])], words: String): Unit =
    assert(fault(readings).exists(_.contains(words)), fault(readings).toString)

  test("a running clock has no fault, whatever its epoch, with quartz drift and over any link"):
    for epoch <- Seq(0.0, 12345.678, -3e8, 1.7e9) do
      assertEquals(fault(readings()((_, s) => epoch + s * 1.0001)), None)

  test("a clock that runs backwards is reported as a fault immediately"):
    assertFault(readings()((_, s) => if s < 10 then s else 20 - s), "ran back by 0.")

  test("a clock that stops is reported as a fault within a second, even if vehicles move"):
    assertFault(readings()((_, s) => s.min(10)), "stood still for 0.")
    assertEquals(fault(readings(10.4)((_, s) => s.min(10))), None)
    assertFault(readings()((_, _) => 0.0), "stood still")

  test("a clock that jumps once is reported as a fault, whatever the direction and size of the jump"):
    for jump <- Seq(0.8, 5.0, 3600.0) do
      assertFault(readings()((_, s) => if s < 10 then s else s + jump), "advanced by")
    for jump <- Seq(0.3, 5.0, 3600.0) do
      assertFault(readings()((_, s) => if s < 10 then s else s - jump), "ran back by")

  test("time at half or double speed for two seconds is a fault, and so is a rate that is wrong by a tenth"):
    for rate <- Seq(0.5, 2.0) do
      assertFault(
        readings()((_, s) =>
          if s < 10 then s else if s < 12 then 10 + (s - 10) * rate else 10 + 2 * rate + s - 12
        ),
        "advanced by"
      )
    for rate <- Seq(0.9, 1.1) do assertFault(readings()((_, s) => s * rate), "advanced by")

  test("a single wrong time stamp is reported as a fault, whatever its value"):
    val sound = readings()((_, s) => s)
    for at <- Seq(0L, -1L, Long.MaxValue, Long.MinValue, 42_000_000_000L) do
      val bad = sound.updated(100, (sound(100)._1, sound(100)._2.copy(validAt = Instant.ofNanos(at))))
      assert(fault(bad).isDefined, s"time stamp $at")

  test("a counter that wraps around is reported as a fault"):
    val wraps = 15.0
    assertFault(readings()((_, s) => s % wraps), "ran back by 14.")

  test("clocks that differ between vehicles are reported as a fault that names both vehicles"):
    for by <- Seq(0.25, -0.25, 5.0, -3600.0) do
      val told = fault(readings()((vehicle, s) => if vehicle == "a" then s else s + by))
      assert(
        told.exists(text => text.contains("the clocks of ") && text.contains("share one")),
        s"$by s: $told"
      )

  test("a slightly wrong clock is reported as long as it is wrong, and is not a fault"):
    def axis(lastsS: Double) = readings(lastsS)((_, s) => if s < 10 then s else s - (s - 10).min(0.3) * 0.99)
      .foldLeft(TimeAxis.begun)((axis, one) => axis.updated(one._1, one._2))
    assertEquals((axis(9).fault, axis(9).wandering), (None, None))
    assertEquals(axis(12).fault, None)
    assert(
      axis(12).wandering.exists(_.contains("the simulator's clock advanced by")),
      axis(12).wandering.toString
    )
    assertEquals((axis(24).fault, axis(24).wandering), (None, None))

  test("answers that arrive late and overtake each other are not a fault"):
    val late = readings()((_, s) => s).zipWithIndex.map: (one, index) =>
      val more = Span.ofSeconds(if index % 40 == 7 then 3.0 else 0.0)
      (one._1, one._2.copy(receivedAt = one._2.receivedAt + more))
    assertEquals(fault(late.sortBy(_._2.receivedAt)), None)

  private def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)

  test(
    "a step of a stopped simulator is a fault if its duration is zero, negative or too long, or if time " +
      "runs between"
  ):
    val period                                                       = Span.ofMillis(100)
    def step(before: Option[Double], oldest: Double, newest: Double) =
      TimeAxis.steppedFault(before.map(at), at(oldest), at(newest), period)
    for sound <- Seq(100.0, 99.0, 103.0, 150.0, 60.0) do
      assertEquals(step(Some(500), 500 + sound, 500 + sound), None, s"$sound ms")
    assertEquals(step(None, 500, 503), None)
    assert(step(Some(500), 500, 500).exists(_.contains("stood still")))
    assert(step(Some(500), 400, 400).exists(_.contains("ran back by 0.10 s")))
    assert(step(Some(500), 900, 900).exists(_.contains("advanced by 0.40 s in a step of 0.10 s")))
    assert(step(Some(500), 600, 900).exists(_.contains("does not stand still")))
