package skein.bench.jmh

import org.openjdk.jmh.annotations.*
import skein.bench.Works
import skein.forward.{DelayTable, Delays, LoopTiming}
import skein.lanes.{DuelBatch, DuelWorlds}
import skein.policy.{ChauffeurEvader, HeadingPolicy, PolicyFamily}

/** What does a family of policies cost? Millions of agent-steps a second, on one thread: 1,024 candidates of
  * the family, drawn from its space, fly one episode of 60 s of `stream` over `vpn` against the chauffeur's
  * evader.
  */
class PolicyBenchmark extends Rate:
  @Param(Array("paper-pursuer", "pure-pursuit", "proportional-navigation", "lead-pursuit", "neural:8x8"))
  var family: String = ""

  private var batch: DuelBatch   = null
  private var worlds: DuelWorlds = null
  private var witness            = 0.0

  @Setup
  def prepare(): Unit =
    batch = Works.batch(LoopTiming.Stream(), 1)
    val chosen   = PolicyFamily.parse(family).toOption.get
    val policies = chosen.space.random(1024, 1).map(chosen.policy).toArray
    val opponent = ChauffeurEvader()
    worlds = new DuelWorlds:
      def size: Int                          = policies.length
      override def shareEpisodes: Boolean    = true
      def key(world: Int): Int               = 1
      def link(world: Int): Delays           = DelayTable.vpn
      def pursuer(world: Int): HeadingPolicy = policies(world)
      def evader(world: Int): HeadingPolicy  = opponent

  @TearDown
  def show(): Unit = println(f"witness, mean of the last 10 s: $witness%.4f m")

  @Benchmark
  @OperationsPerInvocation(1024 * 1200)
  def candidates(): Double =
    witness = batch.fly(worlds).meanLast10sM.map(_.toDouble).sum / worlds.size
    witness
