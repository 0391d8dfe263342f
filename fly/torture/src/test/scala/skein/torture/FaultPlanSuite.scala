package skein.torture

import skein.link.Fault
import skein.loop.LoopKind
import skein.scenario.PaperDuel
import skein.units.*

/** The faults drawn from seeds: enough of every kind, and none in the calm. */
class FaultPlanSuite extends munit.FunSuite:
  private val duration   = Span.ofSeconds(30)
  private val start      = Span.ofMillis(500)
  private val faultPlans = (1L to 4000L).map(FaultPlan.of(_, duration))

  private def often(
      what: String,
      expected: Double,
      among: Seq[FaultPlan] = faultPlans
  )(is: FaultPlan => Boolean): Unit =
    val share  = among.count(is) / among.size.toDouble
    val spread = 4 * math.sqrt(expected * (1 - expected) / among.size)
    assert((share - expected).abs <= spread, s"$what in $share of ${among.size}, not in $expected")

  private def pairs(faultPlan: FaultPlan) = faultPlan.scenario.agents.size / 2

  test("equal seeds and durations give equal fault plans, and another seed gives another"):
    assertEquals(FaultPlan.of(7, duration), faultPlans(6))
    assertEquals(faultPlans.map(_.copy(seed = 0)).distinct.size, faultPlans.size)

  test("there are no faults in the first half second and the last five, except of the disk and an early end"):
    for faultPlan <- faultPlans do
      assertEquals((faultPlan.duration, faultPlan.calmFrom), (duration, duration - Span.ofSeconds(5)))
      for fault <- faultPlan.faults do
        val lasts = fault.fault match
          case Fault.Stall(span)   => span
          case Fault.Silence(span) => span
          case _                   => Span.Zero
        assert(lasts <= Span.ofSeconds(4), faultPlan.toString)
        assert(fault.at >= start && fault.at + lasts <= faultPlan.calmFrom, faultPlan.toString)
      faultPlan.disk match
        case Disk.Blocks(at, lasts, capacity) =>
          assert(at >= start && at + lasts <= faultPlan.calmFrom && capacity >= 50, faultPlan.toString)
        case Disk.Fails(at) => assert(at >= start && at <= duration, faultPlan.toString)
        case Disk.Sound     => ()
      assert(faultPlan.stopAt.forall(at => at >= start && at <= duration), faultPlan.toString)

  test("restarts follow each other with time for the supervisor between them, before the calm"):
    for faultPlan <- faultPlans do
      for restart <- faultPlan.restarts do
        assert(restart.at >= start && restart.lasts <= Span.ofSeconds(3), faultPlan.toString)
        assert(restart.clockJump.toSeconds.abs <= 20, faultPlan.toString)
      for (one, next) <- faultPlan.restarts.zip(faultPlan.restarts.drop(1)) do
        assert(one.at + one.lasts + Span.ofMillis(200) <= next.at, faultPlan.toString)
      for last <- faultPlan.restarts.lastOption do
        assert(last.at + last.lasts + Span.ofMillis(200) <= faultPlan.calmFrom, faultPlan.toString)
    assertEquals(faultPlans.map(_.restarts.size).distinct.sorted.toSeq, Seq(0, 1, 2, 3, 4, 5))

  test("each loop, link and fault is drawn about as often as intended"):
    val others = faultPlans.filterNot(_.loop == LoopKind.Paused)
    often("the paused truth", 0.1)(_.loop == LoopKind.Paused)
    often("streams", 0.4, others)(_.loop == LoopKind.Stream)
    for loop <- Seq(LoopKind.Predictive, LoopKind.Futures, LoopKind.Sequential) do
      often(loop.label, 0.2, others)(_.loop == loop)
    for link <- faultPlans.map(_.link.name).distinct do often(link, 0.25)(_.link.name == link)
    assertEquals(faultPlans.map(_.link.name).distinct.size, 4)
    often("a camera", 0.2, others)(_.looks)
    assert(!faultPlans.exists(plan => plan.looks && plan.loop == LoopKind.Paused))
    often("segments cut", 0.5)(_.cutsSegments)
    often("a fault of the link", 0.6)(_.faults.nonEmpty)
    often("two of them", 0.36)(_.faults.sizeIs >= 2)
    often("restarts", 0.35)(_.restarts.nonEmpty)
    often(
      "a jump of the clock",
      0.5,
      faultPlans.filter(_.restarts.nonEmpty)
    )(_.restarts.head.clockJump != Span.Zero)
    often("a sound disk", 0.85)(_.disk == Disk.Sound)
    often("a disk that fails", 0.075)(_.disk.isInstanceOf[Disk.Fails])
    often("an early end", 0.1)(_.stopAt.isDefined)
    often("lost answers", 0.3)(_.messageFaults.lost > 0)
    for (what, of) <- Seq[(String, MessageFaults => Double)](
        "late"     -> (_.late),
        "doubled"  -> (_.doubled),
        "nonsense" -> (_.nonsense),
        "stray"    -> (_.stray),
        "garbage"  -> (_.garbage),
        "refused"  -> (_.refused)
      )
    do often(what, 0.3)(faultPlan => of(faultPlan.messageFaults) > 0)
    often("a file", 0.1)(_.isFiled)
    often("as published", 0.2, others.filter(_.loop == LoopKind.Stream))(each =>
      each.scenario.isAsPublished
    )

  test("message faults are limited, so that flights still have results"):
    for faultPlan <- faultPlans do
      val MessageFaults(late, lateBy, doubled, nonsense, stray, garbage, refused, lost) =
        faultPlan.messageFaults
      for (p, most) <- Seq(late -> 0.2, doubled -> 0.3, nonsense -> 0.1, stray -> 0.2, garbage -> 0.02) ++
          Seq(refused -> 0.3, lost -> 0.2)
      do assert(p >= 0 && p <= most, faultPlan.toString)
      assert(lateBy <= Span.ofSeconds(1.5), faultPlan.toString)
    assert(faultPlans.map(_.messageFaults.late).max > 0.19 && faultPlans.map(_.messageFaults.lost).max > 0.19)

  test("a fault plan draws as many vehicles as its loop can serve, and not always two"):
    for faultPlan <- faultPlans do
      val most = faultPlan.loop match
        case LoopKind.Paused                        => 2
        case LoopKind.Sequential | LoopKind.Futures => 3
        case _                                      => 10
      assert(pairs(faultPlan) >= 1 && pairs(faultPlan) <= most, faultPlan.toString)
      assert(
        !faultPlan.scenario.isAsPublished || faultPlan.loop == LoopKind.Stream,
        faultPlan.toString
      )
    val streams = faultPlans.filter(_.loop == LoopKind.Stream)
    often("one pair", 0.6 + 0.4 / 10, streams)(pairs(_) == 1)
    assertEquals(streams.map(pairs).distinct.sorted, (1 to 10).toSeq)

  test("the simulator's clock is ahead or behind by up to 20 s"):
    val ahead = faultPlans.map(_.clockAhead.toSeconds)
    assert(ahead.forall(_.abs <= 20) && ahead.min < -19.5 && ahead.max > 19.5)
    often("ahead", 0.5)(_.clockAhead > Span.Zero)

  test("a flight too short for faults is refused, and the shortest valid one is not"):
    val refused = intercept[IllegalArgumentException](FaultPlan.of(1, FaultPlan.Shortest - Span.ofMillis(1)))
    assert(refused.getMessage.contains("6.5 s at least"), refused.getMessage)
    for seed <- 1L to 200L do assert(FaultPlan.of(seed, FaultPlan.Shortest).calmFrom > start)

  test("a flight of seven seconds has at most one restart"):
    val short = (1L to 400L).map(FaultPlan.of(_, FaultPlan.Shortest)).flatMap(plan =>
      plan.restarts.headOption.map(plan -> _)
    )
    assert(short.nonEmpty && short.forall((plan, _) => plan.restarts.sizeIs == 1))
    for (plan, restart) <- short do assert(restart.at + restart.lasts <= plan.calmFrom, plan.toString)

  test("another scenario uses the drawn loop, or stream if the loop cannot serve its vehicles"):
    def flown(loop: LoopKind, pairs: Int) =
      val plan = faultPlans.head.copy(loop = loop).flying(PaperDuel(pairs))
      assertEquals(plan.scenario, PaperDuel(pairs))
      plan.loop
    assertEquals((flown(LoopKind.Paused, 2), flown(LoopKind.Paused, 3)), (LoopKind.Paused, LoopKind.Stream))
    for loop <- Seq(LoopKind.Sequential, LoopKind.Futures) do
      assertEquals((flown(loop, 3), flown(loop, 4)), (loop, LoopKind.Stream))
    assertEquals(flown(LoopKind.Predictive, 10), LoopKind.Predictive)

  test("a line for people lists exactly the faults of a plan"):
    val calm = faultPlans.head.copy(
      loop = LoopKind.Stream,
      scenario = PaperDuel(2),
      faults = Vector.empty,
      messageFaults = MessageFaults.None,
      restarts = Vector.empty,
      disk = Disk.Sound,
      stopAt = None
    )
    assertEquals(calm.toString, s"seed 1: stream, 4 vehicles, ${calm.link.name}")
    val all = calm.copy(
      scenario = PaperDuel(2, asPublished = true),
      faults = Vector(skein.link.TimedFault(Span.ofMillis(900), Fault.Reset)),
      messageFaults = MessageFaults(lost = 0.1),
      restarts = Vector(Restart(Span.ofSeconds(2), Span.ofSeconds(1), Span.Zero)),
      disk = Disk.Fails(Span.ofSeconds(3)),
      stopAt = Some(Span.ofSeconds(4))
    )
    for part <- Seq(
        "stream as published,",
        "Reset at 900 ms",
        "restart at 2000 ms for 1000 ms",
        "0.1)",
        "Fails(",
        "stopped at 4000 ms"
      )
    do assert(all.toString.contains(part), s"no '$part' in: $all")
