package skein.torture

import skein.loop.{LoopKind, FlightOutcome}
import skein.record.EventKind
import skein.scenario.Forest
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** Whole flights with seeded faults, in virtual time. */
class TortureSimulation extends munit.FunSuite, Unhurried:

  private val duration = Span.ofSeconds(8)
  private val seeds    = 24

  test(s"$seeds flights through faults of network, simulator, answers and disk break no rule"):
    var failed = Vector.empty[String]
    Torture.all(
      Iterator.range(1, seeds + 1).map(_.toLong),
      duration,
      threads = Runtime.getRuntime.availableProcessors
    ): verdict =>
      if !verdict.isClean then
        val again = s"./skein torture --first ${verdict.faultPlan.seed} --seeds 1 --duration 8s"
        failed :+= (verdict.faultPlan.toString +: verdict.violations :+ again).mkString("\n  ")
    assert(failed.isEmpty, failed.mkString("\n", "\n", ""))

  test("a team that relies on its lidars breaks no rule under faults"):
    for seed <- 1L to 2L do
      val verdict = Torture.of(seed, duration, Some(Forest()), None)
      assert(verdict.isClean, (verdict.faultPlan.toString +: verdict.violations).mkString("\n  "))

  test("a disk that is full at the last answers fails the flight"):
    val full      = Disk.Fails(duration - Span.ofMillis(8))
    val faultPlan = FaultPlan.of(seed = 1, duration).copy(
      loop = LoopKind.Futures,
      link = LatencyProfile.vpn,
      faults = Vector.empty,
      messageFaults = MessageFaults.None,
      restarts = Vector.empty,
      disk = full,
      stopAt = None
    )
    val seen = TortureFlight.fly(faultPlan)
    assertEquals(
      seen.outcome,
      FlightOutcome.Failed("cannot write to recording flight.duckdb: the disk is full"),
      faultPlan.toString
    )
    assertEquals(Checks.violations(seen), Vector.empty, faultPlan.toString)

  test(
    "late, lost, wrong and unrecognised images are counted separately, and all other images are searched"
  ):
    val plans = Iterator.from(1).map(seed => FaultPlan.of(seed, duration)).filter(_.looks).take(6).toVector
    val seen  = plans.map(TortureFlight.fly)
    for flight <- seen do assertEquals(Checks.violations(flight), Vector.empty, flight.faultPlan.toString)
    val all = seen.flatMap(_.images)
    assertEquals(all.size, plans.size)
    assert(all.forall(_.due >= 60 / 2), s"$all")
    assert(all.map(_.searched).sum > 0 && all.map(_.missed).sum > 0 && all.map(_.lost).sum > 0, s"$all")
    val told = seen.flatMap(_.recording.events).filter(_.detail.startsWith("faulty eye: ")).map(_.kind).toSet
    assert(
      Set(EventKind.Skipped, EventKind.DeadlineMissed, EventKind.Refused, EventKind.TimedOut).subsetOf(told),
      s"$told"
    )

  test("equal seeds give equal flights"):
    for seed <- Seq(3L, 11L) do
      val Seq(one, other) = Seq.fill(2)(TortureFlight.fly(FaultPlan.of(seed, duration)))
      assertEquals(one.arrivals, other.arrivals, s"seed $seed")
      assertEquals(one.recording, other.recording, s"seed $seed")
      assertEquals(one.stats, other.stats, s"seed $seed")

  test("a flight that dies of any error is a violation, not a missing seed"):
    assertEquals(
      Torture.violations(throw StackOverflowError("deep")),
      Vector("java.lang.StackOverflowError: deep")
    )
    assertEquals(Torture.violations(throw InterruptedException("cut")).size, 1)
    assertEquals(Torture.violations(Vector.empty), Vector.empty)
