package skein.flight

import java.nio.file.Files
import java.util.concurrent.Executors
import skein.loop.{LoopKind, FlightOutcome}
import skein.policy.{Axis, PolicyFamily, Role, SearchSpace}
import skein.record.Digest
import skein.settings.{ChosenPolicy, FlightPlan, FlySettings, PolicyFile}
import skein.signal.LatencyProfile
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.*
import skein.vtime.{Problem, RunLimits, VirtualTimeException}

/** Whole flights in virtual time repeat exactly. */
class VirtualFlightSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:

  private val settings = FlySettings(
    List(LoopKind.Sequential, LoopKind.Stream),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(3),
    period = Span.ofMillis(100),
    seed = 7
  )

  private def digest(plan: FlightPlan): Digest =
    val flown = VirtualFlights.fly(settings, plan).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    assert(flown.recorder.records.size > 50)
    flown.recorder.digest

  test("equal flights have equal recordings, repeated and during another flight on another thread"):
    val plans   = settings.plans
    val alone   = plans.map(digest)
    val threads = Executors.newFixedThreadPool(2)
    val beside  =
      try plans.map(plan => threads.submit(() => digest(plan))).map(_.get())
      finally threads.shutdown()
    assertEquals(beside, alone)
    assertEquals(digest(plans.last), alone.last)

  test("another seed gives another recording"):
    val plan = settings.plans.last
    assertNotEquals(digest(plan.copy(seed = plan.seed + 1)), digest(plan))

  test(
    "a paused flight without delays passes in one instant, and its limit of tasks grows with its duration"
  ):
    val paused = settings.copy(loops = List(LoopKind.Paused), links = List(LatencyProfile.none))
    val flown  = VirtualFlights.fly(paused, paused.plans.head, RunLimits(tasksPerInstant = 1))
    assertEquals(flown.map(_.landed.outcome), Right(FlightOutcome.Completed))

  test("a flight that ends by any error is reported with its seed, and the others still run"):
    val plan  = settings.plans.head
    val plans = Vector.tabulate(6)(number => plan.copy(seed = number.toLong))
    val flown = VirtualFlights.eachInParallel(plans): plan =>
      plan.seed match
        case 1 => Left("no link")
        case 3 => throw StackOverflowError("too deep")
        case 4 => throw InterruptedException("cut")
        case _ => Right(plan.seed)
    val (missing, landed) = flown.partitionMap(identity)
    assertEquals(landed, Vector(0L, 2L, 5L))
    assertEquals(missing.map(_.plan.seed), Vector(1L, 3L, 4L))
    val message = NotFlown.message(missing, plans.size)
    assert(message.startsWith("3 of 6 flights could not be flown"), message)
    for told <- Seq("seed 1: no link", "seed 3: java.lang.StackOverflowError: too deep", "seed 4: ") do
      assert(message.contains(told), message)

  folder.test("flights that cannot be flown are named, and the others are recorded"): folder =>
    val space  = SearchSpace(Vector(Axis("lead", 0, 1, 0.5)))
    val broken = PolicyFamily("broken", "", Set(Role.Pursuer), space, _ => sys.error("no"))
    val plan   = settings.plans.last
    val other  = plan.copy(
      id = "broken",
      policy = Some(ChosenPolicy("broken", PolicyFile(Role.Pursuer, broken, space.defaults)))
    )
    val (missing, landed) = VirtualFlights.fly(settings, Vector(other, plan), folder)((_, _) => ())
    assertEquals((missing.map(_.plan.id), landed.map(_.plan.id)), (Vector("broken"), Vector(plan.id)))
    assert(Files.exists(plan.file(folder)))

  test("a missing agent of virtual time is reported in words, and any other error with its stack"):
    val missing = VirtualTimeException(Problem.NoAgent("Pekko reads the JVM's clock"))
    for thrown <- Seq(missing, RuntimeException(missing)) do
      assertEquals(NotFlown.trace(thrown), missing.getMessage)
    val blocked = VirtualTimeException(Problem.Blocked("Await.result"))
    assertEquals(NotFlown.mendable(blocked), None)
    assert(clue(NotFlown.trace(blocked)).contains("\tat "))
