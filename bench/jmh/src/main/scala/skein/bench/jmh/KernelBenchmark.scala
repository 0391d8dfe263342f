package skein.bench.jmh

import org.openjdk.jmh.annotations.*
import skein.bench.Works
import skein.forward.{DelayTable, Duel, LoopTiming, Rollout}
import skein.lanes.DuelBatch
import skein.simd.WorldRandom

/** How many million agent-steps a second do the engines of forward simulation make, on one thread? `stream`
  * over `vpn`, 60 s, the reduced model; an agent-step is 0.1 s of one agent.
  */
class KernelBenchmark extends Rate:
  private var batch: DuelBatch = null
  private var rollout: Rollout = null
  private var witness          = 0.0

  @Setup
  def prepare(): Unit =
    batch = Works.batch(LoopTiming.Stream(), 1)
    rollout = Rollout(Duel.paper, LoopTiming.Stream(), DelayTable.vpn, Works.model)

  @TearDown
  def show(): Unit = println(f"witness, mean of the last 10 s: $witness%.4f m")

  /** All candidates on one episode, whose timetable is computed by the first call. */
  @Benchmark
  @OperationsPerInvocation(1024 * 1200)
  def candidates(): Double = fly(Works.Candidates(1024, 1024, DelayTable.vpn, 1))

  /** Every world with independent delays. */
  @Benchmark
  @OperationsPerInvocation(1024 * 1200)
  def singleWorlds(): Double = fly(Works.Candidates(1024, 1, DelayTable.vpn, 1))

  /** The scalar reference, which supports any policy and any model. */
  @Benchmark
  @OperationsPerInvocation(1200)
  def scalar(): Double =
    witness = rollout.fly(WorldRandom.key(1, 0, 0)).meanLast10sM
    witness

  private def fly(candidates: Works.Candidates): Double =
    witness = batch.fly(candidates).meanLast10sM.map(_.toDouble).sum / candidates.size
    witness
