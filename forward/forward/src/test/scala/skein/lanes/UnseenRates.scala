package skein.lanes

import skein.formula.Trace
import skein.forward.{DelayTable, Pair, LoopTiming, Rollout, VelocityResponses}
import skein.lanes.LanePolicies.take
import skein.lanes.policy.PolicyLanes
import skein.lanes.score.{Judged, ScoreLanes, Scoreboard}
import skein.lanes.timetable.{Timetable, TimetableKernel}
import skein.policy.PolicyFamily
import skein.scenario.{Reduction, Separation}
import skein.signal.SplitMix64

/** Measures the speed of a search over policies that the product does not contain. Run: `forward/Test/runMain
  * skein.lanes.unseenRates`. Simulates on one thread 1,024 candidates of one episode, 60 s of `stream` over
  * `vpn`, and for comparison the paper's pursuer and the scalar engine. Prints millions of agent-steps of 0.1
  * s per second of processor time, and the number of operations in the compiled expression.
  */
@main def unseenRates(rounds: Int*): Unit =
  val model  = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  val timing = LoopTiming.Stream()
  val paper  = (random: SplitMix64) => PolicyFamily.paperPursuer.policy(Vector(0.5 + random.nextDouble()))
  val times  = java.lang.management.ManagementFactory.getThreadMXBean

  def seconds(work: => Unit): Double =
    val from = times.getCurrentThreadCpuTime
    work
    (times.getCurrentThreadCpuTime - from) * 1e-9

  for _ <- 1 to rounds.headOption.getOrElse(2); (name, draw) <- ("paper" -> paper) +: UnseenPolicySuite.Unseen
  do
    val random     = SplitMix64(3)
    val candidates = Array.fill(PairKernels.WORLDS)(draw(random))
    val lanes      = LaneDynamics.of(model).fold(sys.error, identity)
    val both       = Vector.fill(2)(lanes)
    val table      = Timetable.of(both, 60, timing, DelayTable.vpn, 1)
    val started    = System.nanoTime
    val pursuers   = LanePolicies.of(candidates(0))
    val compiledMs = (System.nanoTime - started) / 1_000_000
    val evaders    = LanePolicies.of(UnseenPolicySuite.Evader)
    val agents     = Vector(Pair.paper.evader, Pair.paper.pursuer)
    val members    = Opponents.inEpisode(agents, both, Vector(evaders, pursuers), Map.empty)
    val scores     = Scoreboard(
      ScoreLanes.of(Vector(Judged(Separation, Reduction.Mean, 50.1)), 2).fold(throw _, identity),
      Vector(0, 0)
    )
    val kernel                   = TimetableKernel(members.map(identity), scores)
    def fly(episodes: Int): Unit = for _ <- 1 to episodes do
      for world <- 0 until PairKernels.WORLDS do
        pursuers.take(world, candidates(world))
        evaders.take(world, UnseenPolicySuite.Evader)
      kernel.fly(table, PairKernels.WORLDS)
    fly(1000)
    val rate = Vector.fill(5)(200 * PairKernels.WORLDS * 1200 / seconds(fly(200))).max * 1e-6
    def scalar(count: Int): Unit = for world <- 0 until count do
      val duel = Pair(
        Pair.paper.pursuer.copy(policy = candidates(world % PairKernels.WORLDS)),
        Pair.paper.evader.copy(policy = UnseenPolicySuite.Evader),
        60
      )
      Rollout(duel.engagement, timing, DelayTable.vpn, model).fly(1): Unit
    scalar(150)
    val slow    = Vector.fill(3)(60 * 1200 / seconds(scalar(60))).max * 1e-6
    val size    = Trace.needed(PolicyLanes.get(candidates(0)).outputs).count(_.args.nonEmpty)
    val witness = scores.values(0).map(_.toDouble).sum / PairKernels.WORLDS
    println(
      f"$name%-8s $rate%6.1f M/s  scalar $slow%.3f M/s  ${rate / slow}%5.0f times  $size%4d operations " +
        f" ${rate * size}%7.0f M operations/s  made in $compiledMs ms  witness $witness%.5f"
    )
