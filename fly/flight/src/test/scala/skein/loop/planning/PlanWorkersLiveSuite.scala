package skein.loop.planning

import java.util.concurrent.{ConcurrentLinkedQueue, ThreadFactory}
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import skein.flight.FlightAssembler
import skein.link.BackgroundThread
import skein.planning.*
import skein.testing.Optimised
import skein.units.Span
import skein.vehicle.{PlaneReading, ReducedModel}

/** Searches on threads and the real clock: the number of slices depends on the machine, and the result of a
  * number of slices does not.
  */
class PlanWorkersLiveSuite extends munit.FunSuite, Optimised:
  private val settings  = PlannerSettings(blocksPerSlice = 1)
  private val objective = PlanCost(CommandLimits.paperPursuer, cruiseSpeed = 10)

  private def vehicle(at: PlaneReading) = PredictedVehicle(ReducedModel.AirSim, at)

  private def problem(stream: Long): PlanProblem =
    val goal      = Target.Along(PredictedTrack.standing(10, 10, settings.steps))
    val situation = Situation(vehicle(PlaneReading(0, 0, 5, 0)), 0, 0.1, Vector(Behaviour(goal)))
    // Two vehicles, of which one finds the other in its way.
    val meeting = vehicle(PlaneReading(8, 8, -2, -2))
    PlanProblem(
      settings,
      Vector(
        Part(objective, situation, stream),
        Part(
          objective.copy(separation = SeparationCost(2)),
          situation.copy(own = meeting, headingRad = math.Pi),
          stream + 100
        )
      )
    )

  private def warm(problem: PlanProblem): JointPlan = JointPlanner().resumed(problem, None)

  private def workersOn(
      factory: ThreadFactory,
      usual: ThreadFactory,
      patience: Span = BackgroundThread.Patience
  ) =
    ThreadedPlanWorkers(
      2,
      slice => FlightAssembler.asPlanThread(BackgroundThread(factory, usual, patience)(slice))
    )

  private val named = Thread.ofPlatform().daemon().name("skein-plan").factory()

  private val workers = FunFixture[ThreadedPlanWorkers](_ => workersOn(named, named), _.close())

  /** Polls until all searches have finished this number of slices. */
  private def finished(workers: PlanWorkers, problem: PlanProblem): Vector[JointPlan] =
    val search   = workers.begin(problem, warm(problem))
    val deadline = System.nanoTime() + 60_000_000_000L
    while System.nanoTime() < deadline && !search.found.forall(_.slices > 3) do Thread.sleep(1)
    search.finish()

  workers.test("the result of threads after a number of slices is reproduced by counted slices"): workers =>
    for stream <- 1 to 3 do
      val found   = finished(workers, problem(stream))
      val planner = JointPlanner()
      assert(found.forall(_.slices > 3), found.map(_.slices).toString)
      for (plan, search) <- found.zipWithIndex do
        val again = planner.searched(problem(stream), warm(problem(stream)), search, plan.slices)
        assertEquals(
          again.plans.map(_.manoeuvre.turnRates.toSeq),
          plan.plans.map(_.manoeuvre.turnRates.toSeq)
        )
        assertEquals(again.plans.map(_.cost), plan.plans.map(_.cost))

  workers.test("several problems take turns"): workers =>
    val searches = Vector.tabulate(5)(stream => workers.begin(problem(stream), warm(problem(stream))))
    val deadline = System.nanoTime() + 60_000_000_000L
    while System.nanoTime() < deadline && !searches.forall(_.found.forall(_.slices > 3)) do
      Thread.sleep(1)
    assert(searches.flatMap(_.finish()).forall(_.slices > 3))

  workers.test("a search that was ended finds no further candidates"): workers =>
    val search = workers.begin(problem(1), warm(problem(1)))
    val found  = search.finish()
    val later  = finished(workers, problem(2))
    assert(later.forall(_.slices > 3))
    assertEquals(search.finish().map(_.slices), found.map(_.slices))

  test(
    "a thread that takes too long for a slice is replaced by one of usual priority, and the search continues"
  ):
    val usual   = Thread.ofPlatform().daemon().name("usual-", 1).factory()
    val made    = AtomicInteger()
    val gaveWay = ConcurrentLinkedQueue[Thread]()
    val workers = workersOn(
      work =>
        val thread = Thread(work)
        gaveWay.add(thread)
        thread
      ,
      work =>
        made.incrementAndGet()
        usual.newThread(work)
      ,
      patience = Span.ofSeconds(-1)
    )
    try
      assert(finished(workers, problem(1)).forall(_.slices > 3))
      gaveWay.forEach(_.join(60_000))
      assert(!gaveWay.asScala.exists(_.isAlive))
      assertEquals(made.get, 2)
    finally workers.close()

  test("threads end when the workers are closed"):
    def ours    = Thread.getAllStackTraces.keySet.asScala.filter(_.getName.startsWith("skein-plan")).toSet
    val before  = ours
    val closing = workersOn(named, named)
    val begun   = ours -- before
    assertEquals(begun.size, 2)
    closing.close()
    begun.foreach(_.join(60_000))
    assert(!begun.exists(_.isAlive))
