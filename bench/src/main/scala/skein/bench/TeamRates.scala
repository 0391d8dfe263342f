package skein.bench

import java.lang.management.ManagementFactory
import skein.forward.{DelayTable, Delays, Engagement, LoopTiming}
import skein.lanes.{ScalarTeam, TeamBatch, TeamCandidate, TeamWorlds}
import skein.lanes.score.Judged
import skein.policy.{Action, Policy, Fleet, Observation, PaperPursuer}
import skein.scenario.*
import skein.simd.WorldRandom
import skein.units.Radians

/** How fast are teams in forward simulation, with SIMD and by the scalar engine? 256 candidates of one
  * episode, and 256 with delays of their own, `stream` over `vpn`, 60 s, the reduced model, one thread; an
  * agent-step is 0.1 s of one vehicle. Timetables are computed before; their cost is printed separately. Run:
  * `./sbtw "bench/runMain skein.bench.TeamRates 6 20"`.
  */
object TeamRates:
  private val Candidates = 256
  private val DurationS  = 60.0

  /** Flights before measuring, until the compilers are done. */
  private val WarmUp = 60

  def main(args: Array[String]): Unit =
    println(
      "| team | delays | SIMD, M agent-steps per processor second | scalar | " +
        "ratio | first flight of an episode, ms | witness | scalar's |"
    )
    println("|---|---|---|---|---|---|---|---|")
    for
      vehicles     <- if args.isEmpty then Seq(6, 20, 64) else args.toSeq.map(_.toInt)
      (name, draw) <-
        Seq("surround" -> surround(vehicles), "formation" -> formation(vehicles)) ++
          // More would exceed the operations that a formula may have.
          Option.when(vehicles <= 32)("crossing" -> crossing(vehicles)) ++
          Option.when(vehicles == 2)("paper's duel" -> duel(number => PaperPursuer(0.8 + 0.001 * number))) ++
          Option.when(vehicles == 2)("README's chase" -> duel(_ => Chase))
      shared <- Seq(true, false)
    do
      val candidates    = Vector.tabulate(Candidates)(draw)
      val batch         = TeamBatch(LoopTiming.Stream(), Works.model, 1)
      val steps         = vehicles * DurationS * 10
      val scalar        = ScalarTeam(LoopTiming.Stream(), Works.model)
      def fly(key: Int) = batch.fly(Worlds(candidates, shared, key))
      def alone(i: Int) = scalar.fly(candidates(i), DelayTable.vpn, key(if shared then 0 else i))(0)
      val first         = Vector.tabulate(8)(episode => cpuS(1)(fly(episode): Unit)).min
      for _ <- 1 to WarmUp do fly(0): Unit
      val again            = Vector.fill(5)(cpuS(5)(fly(0): Unit)).min
      val one              = Vector.fill(3)(cpuS(8)(alone(0): Unit)).min
      val outcomes         = fly(0)
      val (witness, truth) =
        ((0 until 4).map(outcomes.values(0)(_).toDouble).sum / 4, (0 until 4).map(alone).sum / 4)
      println(
        f"| $name of $vehicles | ${if shared then "shared" else "own"} | ${Candidates * steps / again * 1e-6}%.1f | ${steps / one * 1e-6}%.3f | " +
          f"${Candidates * one / again}%.0f | ${(first - again) * 1e3}%.0f | $witness%.4f | $truth%.4f |"
      )

  def surround(vehicles: Int)(number: Int): TeamCandidate =
    val scenario = Surround(vehicles, ringM = 6 + 0.02 * number, pursuerMps = 7 + 0.01 * number)
    candidate(scenario, Vector(OffRing(scenario.ringM), WidestGap))

  def formation(vehicles: Int)(number: Int): TeamCandidate =
    val scenario       = Formation(vehicles, spacingM = 3 + 0.01 * number)
    val (ahead, right) = scenario.slots.unzip
    candidate(scenario, Vector(OffSlots(scenario.circuit, IArray.from(ahead), IArray.from(right))))

  def crossing(vehicles: Int)(number: Int): TeamCandidate =
    candidate(Crossing(vehicles, marginM = 0.5 + 0.005 * number), Vector(Separation))

  private def duel(by: Int => Policy)(number: Int): TeamCandidate =
    val Vector(evader, pursuer) = PaperDuel().agents: @unchecked
    TeamCandidate(
      Engagement.of(Fleet(Vector(evader, pursuer.copy(policy = by(number)))), DurationS),
      Vector(Judged(Separation, Reduction.Mean, DurationS - 10))
    )

  /** Equal to that of examples/chase. */
  private case object Chase extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val way = seen.vehicles(seen.opponent).kinematics.positionNed - seen.own.kinematics.positionNed
      (Action.Along(Radians(StrictMath.atan2(way.y, way.x)), seen.cruise, seen.startDown), ())

  private def candidate(scenario: Scenario, by: Vector[Quantity]) =
    TeamCandidate(
      Engagement.of(scenario.fleet, DurationS),
      by.map(Judged(_, Reduction.Rms, DurationS - 10))
    )

  private def key(episode: Int) = WorldRandom.key(1, 0, episode)

  /** @param from index of the first episode */
  private final class Worlds(candidates: Vector[TeamCandidate], shared: Boolean, from: Int)
      extends TeamWorlds:
    def size: Int                            = candidates.size
    override def shareEpisodes: Boolean      = shared
    def key(world: Int): Int                 = TeamRates.key(if shared then from else from + world)
    def link(world: Int): Delays             = DelayTable.vpn
    def candidate(world: Int): TeamCandidate = candidates(world)

  private val system =
    ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]

  /** Processor seconds of the whole process for one of `rounds` rounds. */
  private def cpuS(rounds: Int)(work: => Unit): Double =
    val before = system.getProcessCpuTime
    for _ <- 1 to rounds do work
    (system.getProcessCpuTime - before) * 1e-9 / rounds
