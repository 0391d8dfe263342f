package skein.bench

import com.sun.management.ThreadMXBean
import java.lang.management.ManagementFactory
import java.util.concurrent.atomic.AtomicLong
import skein.flight.FlightAssembler
import skein.link.BackgroundThread
import skein.loop.planning.{PlanSearch, ThreadedPlanWorkers}
import skein.planning.*
import skein.policy.PaperEvader
import skein.vehicle.{PlaneReading, ReducedModel}

/** How many candidate manoeuvres fit into a tick of 100 ms? One candidate is 2 s of flight in 20 steps of
  * pursuer and evader, sampled, simulated, evaluated and used by the search; with several behaviours, once
  * for each. Threads are those of the `plan` loop, which have the lowest priority, so other work on the
  * machine takes its share first: rates are given per second of the clock and of the processor time used.
  * Bytes are a candidate's garbage: above a hundred, a loop of the kernel boxes its vectors, and garbage
  * collections delay decisions.
  *
  * The witness is the cost of the best plan. Run: `./sbtw "bench/runMain skein.bench.PlanBench"`.
  */
object PlanBench:
  private def vehicle(at: PlaneReading) = PredictedVehicle(ReducedModel.AirSim, at)

  private val evader =
    Target.Opponent(vehicle(PlaneReading(15, 3, 4, 0)), speed = 5, headingRad = 0, PaperEvader())

  def problem(behaviours: Int): PlanProblem =
    val settings  = PlannerSettings(blocksPerSlice = 4)
    val objective = PlanCost(CommandLimits.paperPursuer, cruiseSpeed = 10)
    val situation = Situation(
      vehicle(PlaneReading(0, 0, 8, 0)),
      0,
      0.1,
      Behaviours.around(evader, behaviours, stream = 1)
    )
    PlanProblem(settings, Vector(Part(objective, situation, stream = 1)))

  def warm(problem: PlanProblem): JointPlan = JointPlanner().resumed(problem, None)

  def main(args: Array[String]): Unit =
    val seconds = args.headOption.fold(2.0)(_.toDouble)
    val cores   = Runtime.getRuntime.availableProcessors
    println("behaviours  threads  candidates per 100 ms  per 100 ms of processor time  bytes each  witness")
    for behaviours <- Seq(1, 3); threads <- Seq(1, cores).distinct do
      for _ <- 1 to 2 do
        val (byWall, byCpu, bytes, witness) = run(problem(behaviours), threads, seconds)
        println(f"$behaviours%10d $threads%8d $byWall%22.0f $byCpu%29.0f $bytes%11.0f  $witness%.3f")

  /** A search that runs until it is finished, on the `plan` loop's own threads. */
  def endlessly(threads: Int): Option[PlanSearch] =
    Option.when(threads > 0):
      val problem = this.problem(behaviours = 1)
      new ThreadedPlanWorkers(
        threads,
        FlightAssembler.planThreads("skein-plan")
      ).begin(problem, warm(problem))

  private def run(problem: PlanProblem, threads: Int, seconds: Double): (Double, Double, Double, Float) =
    val (candidates, cpuNanos, bytes) = (AtomicLong(), AtomicLong(), AtomicLong())
    val start                         = System.nanoTime()
    val until                         = start + (seconds * 1e9).toLong
    val meter                         = ManagementFactory.getPlatformMXBean(classOf[ThreadMXBean])
    val factory                       = BackgroundThread.factory("bench")
    val best                          = Array.fill(threads)(Float.PositiveInfinity)
    val workers                       = Vector.tabulate(threads): search =>
      factory.newThread: () =>
        val planner = JointPlanner()
        var plan    = warm(problem)
        val before  = (cpu = meter.getCurrentThreadCpuTime, bytes = meter.getCurrentThreadAllocatedBytes)
        while System.nanoTime() < until do
          plan = planner.improved(problem, plan, search)
        cpuNanos.addAndGet(meter.getCurrentThreadCpuTime - before.cpu): Unit
        bytes.addAndGet(meter.getCurrentThreadAllocatedBytes - before.bytes): Unit
        candidates.addAndGet(plan.plans.head.candidates): Unit
        best(search) = plan.plans.head.cost
    workers.foreach(_.start())
    workers.foreach(_.join())
    val wallNanos = System.nanoTime() - start
    (
      candidates.get * 1e8 / wallNanos,
      candidates.get * 1e8 / cpuNanos.get,
      bytes.get.toDouble / candidates.get,
      best.min
    )
