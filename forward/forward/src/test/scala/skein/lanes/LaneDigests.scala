package skein.lanes

import java.util.zip.CRC32
import scala.collection.mutable.ArrayBuffer
import skein.forward.*
import skein.lanes.score.Judged
import skein.planning.*
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.scenario.{Formation, OffRing, Reduction, Scenario, Surround}
import skein.signal.LatencyDistribution
import skein.simd.{LaneMath, WorldRandom}
import skein.units.Span
import skein.vehicle.{PlaneReading, ReducedModel}

/** Prints a line for each engine, plant, loop and policy of the SIMD code, with the checksum of all results'
  * bits. Machines with other vectors print equal lines, except for the first, which states the lane count.
  */
object LaneDigests:
  private val plants = Vector[(String, VelocityResponse)](
    "no lag"    -> VelocityResponses.Ideal,
    "lag"       -> VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05),
    "drag"      -> PlantResponse(ReducedModel.AirSim),
    "bicycle"   -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4)),
    "quadrotor" -> VelocityResponses.quadrotor()
  )

  private def loops(model: VelocityResponse) = Vector(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  /** Fast, slow, and so uneven that answers overtake one another: neighbours in a block differ. */
  private val links = Vector(
    DelayTable.none,
    DelayTable.vpn,
    DelayTable.of(LatencyDistribution.LogNormal(Span.ofMillis(40), 0.8)),
    DelayTable.direct
  )

  private val pursuers = Vector[(String, Int => Policy)](
    "paper" -> (world => PaperPursuer(0.6 + 0.004 * world)),
    "trend" -> (world => TrendPursuer(2 + 0.01 * world, 0.5, 1)),
    "aware" -> (world => AgeAwarePursuer(8, 0.01 * world, 1))
  )

  private final class Bits:
    private val crc                     = CRC32()
    private var count                   = 0
    def take(numbers: Seq[Float]): Unit =
      for number <- numbers do
        val bits = java.lang.Float.floatToRawIntBits(number)
        for byte <- 0 until 4 do crc.update(bits >>> 8 * byte)
        count += 1
    override def toString = f"${crc.getValue}%08x of $count numbers"

  private def duels(
      timing: LoopTiming,
      model: VelocityResponse,
      pursuing: Int => Policy,
      evaderAsideM: Double,
      shared: Boolean,
      count: Int
  ): Bits =
    val duel = Duel.paper.copy(evader = Duel.paper.evader.copy(startY = evaderAsideM), durationS = 4)
    val out  = PairBatch(duel, timing, model, threads = 1).fly(
      new PairWorlds:
        def size: Int                       = count
        override def shareEpisodes: Boolean = shared
        def key(world: Int): Int            = WorldRandom.key(5, 0, if shared then 1 else world)
        def link(world: Int): Delays        = if shared then links(1) else links(world % links.size)
        def pursuer(world: Int): Policy     = pursuing(world)
        def evader(world: Int): Policy      = PaperEvader(7 + 0.01 * world)
      ,
      captureRadiusM = 3.9
    )
    val bits = Bits()
    import out.*
    for numbers <- Seq(minDistanceM, meanDistanceM, meanLast10sM, captureS, pursuerEffortRad, evaderEffortRad)
    do bits.take(numbers.toSeq)
    bits

  private def team(scenario: Int => Scenario, timing: LoopTiming, model: VelocityResponse): Bits =
    val candidates = Vector.tabulate(37): number =>
      val one = scenario(number)
      TeamCandidate(Engagement.of(one.fleet, 3), Vector(Judged(OffRing(5 + 0.1 * number), Reduction.Rms, 0)))
    val out = TeamBatch(timing, model, threads = 1).fly(
      new TeamWorlds:
        def size: Int                            = candidates.size
        override def shareEpisodes: Boolean      = true
        def key(world: Int): Int                 = WorldRandom.key(5, 0, 1)
        def link(world: Int): Delays             = links(1)
        def candidate(world: Int): TeamCandidate = candidates(world)
    )
    val bits = Bits()
    out.values.foreach(numbers => bits.take(numbers.toSeq))
    bits

  /** A joint plan of three pursuers of one evader, which keep apart, slice by slice. */
  private def plan(target: Target): Bits =
    val settings  = PlannerSettings(steps = 20, blocksPerSlice = 2)
    val objective = PlanCost(
      CommandLimits(2, 10, 1.25, 6),
      closest = 0.7,
      capture = 3,
      captureRadius = 4,
      cruiseSpeed = 8,
      separation = SeparationCost(2, margin = 0.8)
    )
    val problem = PlanProblem(
      settings,
      Vector.tabulate(3): self =>
        val from = PredictedVehicle(ReducedModel.AirSim, PlaneReading(3.0 * self, -2.0 * self, 6, 1))
        val seen = Situation(from, 0.2, 0.1, Vector(Behaviour(target)))
        Part(objective, seen, stream = self)
    )
    val planner = JointPlanner()
    val found   = planner.searched(problem, planner.resumed(problem, None), 0, slices = 7)
    val bits    = Bits()
    for plan <- found.plans do
      bits.take(plan.manoeuvre.turnRates.toSeq)
      bits.take(plan.manoeuvre.speeds.toSeq)
      bits.take(Seq(plan.cost))
    bits

  def lines: Seq[String] =
    val lines = ArrayBuffer(s"${LaneMath.LANES} lanes")
    for
      (plant, model)        <- plants
      timing                <- loops(model)
      shared                <- Seq(true, false)
      ((name, pursuer), at) <- pursuers.zipWithIndex
      // The scalar engine, which has no lanes, simulates the others.
      if PairBatch(
        Duel.paper,
        timing,
        model,
        threads = 1
      ).engine(pursuer(0), PaperEvader(), shared, Nil).isFast
    do
      val aside = Seq(0.0, 2.0)(at % 2)
      val count = if plant == "quadrotor" then 9 else 141
      val bits  = duels(timing, model, pursuer, aside, shared, count)
      lines += s"duels ${if shared then "shared" else "own"}, ${timing.productPrefix}, $plant, $name: $bits"
    for
      (plant, model) <- plants.take(3)
      timing         <- loops(model)
      (name, make)   <- Seq[(String, Int => Scenario)](
        "surround"  -> (number => Surround(6, ringM = 5 + 0.1 * number)),
        "formation" -> (number => Formation(spacingM = 3 + 0.1 * number))
      )
    do lines += s"$name, ${timing.productPrefix}, $plant: ${team(make, timing, model)}"
    for
      (name, target) <- Seq(
        "opponent" -> Target.Opponent(
          PredictedVehicle(ReducedModel.AirSim, PlaneReading(9, 4, -2, 3)),
          5,
          2.1,
          PaperEvader()
        ),
        "track" -> Target.Along(PredictedTrack.turning(PlaneReading(3, -5, 4, 1), 0.4, 20, 0.1))
      )
    do lines += s"plan, $name: ${plan(target)}"
    lines.toSeq

/** On each machine: `./sbtw "forward/Test/runMain skein.lanes.printLaneDigests"`. */
@main def printLaneDigests(): Unit = LaneDigests.lines.foreach(println)
