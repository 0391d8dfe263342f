package skein.bench.jmh

import org.openjdk.jmh.annotations.*
import skein.bench.PlanBench
import skein.planning.*

/** How many million manoeuvres does the planner sample, simulate, evaluate and optimise in a second, on one
  * thread? Each is 2 s of pursuer and evader in 20 steps.
  */
class PlanBenchmark extends Rate:
  private val problem         = PlanBench.problem(behaviours = 1)
  private val planner         = JointPlanner()
  private var plan: JointPlan = null

  @Setup(Level.Iteration)
  def begin(): Unit =
    require(
      problem.settings.sliceCandidates == 512,
      s"slices of ${problem.settings.sliceCandidates}"
    )
    plan = PlanBench.warm(problem)

  @TearDown
  def show(): Unit = println(f"witness, cost of the best plan: ${plan.plans.head.cost}%.3f")

  @Benchmark
  @OperationsPerInvocation(512)
  def slices(): JointPlan =
    plan = planner.improved(problem, plan, 0)
    plan
