package skein.bench

import skein.forward.{DelayTable, Engagement, LoopTiming, PlantResponse, VelocityResponses}
import skein.lanes.{ScalarTeam, TeamBatch, TeamCandidate, TeamWorlds}
import skein.lanes.plant.LaneQuadrotors
import skein.optimise.DistanceTerm
import skein.policy.{NeuralPolicy, NeuralShape, PaperPursuer, Policy, Role}
import skein.scenario.PaperDuel
import skein.simd.WorldRandom
import skein.units.Vector3
import skein.vehicle.{Quadrotor, Setpoint}

/** Works of forward simulation, from the yardstick's to realistic ones. */
object Works:
  val model: PlantResponse = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private val AgentStep   = "agent-step: 0.1 s of one agent"
  private val Decision    = "decision of a network with two hidden layers of eight"
  private val VehicleStep = "vehicle-step: 3 ms of the quadrotor and its controller"

  /** The work of `yardstick/chauffeur.c`: ages drawn, positions interpolated, decisions, one exact lag step,
    * distance.
    */
  val yardstick: Work = Work("yardstick, SIMD", AgentStep): thread =>
    val blocks = 2048
    val worlds = blocks * ChauffeurKernel.BLOCK
    (worlds * ChauffeurKernel.TICKS * 2.0, ChauffeurKernel().run(thread, blocks) / worlds)

  val yardstickScalar: Work = Work("yardstick, scalar", AgentStep): thread =>
    val blocks = 16
    val worlds = blocks * ChauffeurKernel.BLOCK
    (worlds * ChauffeurKernel.TICKS * 2.0, ChauffeurScalar.run(thread, blocks) / worlds)

  /** The `stream` loop's full event timing over `vpn`: candidates with shared episodes. */
  val candidates: Work = duels("stream over vpn, candidates of 8 episodes", 16_384, perEpisode = 2048)

  /** The `stream` loop's timing over `vpn`: every world with independent delays. */
  val singleWorlds: Work = duels("stream over vpn, single worlds", 8192, perEpisode = 1)

  private def duels(name: String, worlds: Int, perEpisode: Int): Work = Work(name, AgentStep): thread =>
    val outcomes = batch(LoopTiming.Stream(), 1).fly(Candidates(worlds, perEpisode, DelayTable.vpn, thread))
    (worlds * 1200.0, outcomes.values(0).map(_.toDouble).sum / worlds)

  val streamScalar: Work = Work("stream over vpn, scalar", AgentStep): thread =>
    val episodes = 256
    val scalar   = ScalarTeam(LoopTiming.Stream(), model)
    val team     = TeamCandidate(duel, DistanceTerm.Last10s.judged(60, 0.1).toVector)
    val sum      =
      (0 until episodes).map(i => scalar.fly(team, DelayTable.vpn, WorldRandom.key(thread, 0, i))(0)).sum
    (episodes * 1200.0, sum / episodes)

  val quadrotor: Work = Work("quadrotor, SIMD", VehicleStep): _ =>
    val kernel = LaneQuadrotors.of(Quadrotor.AirSim).fold(sys.error, identity)
    val steps  = 50_000
    for i <- 0 until LaneQuadrotors.VEHICLES do
      kernel.hover(i, Vector3(0, 0, -20))
      kernel.command(i, 10, 0, -20)
    kernel.fly(steps)
    (LaneQuadrotors.VEHICLES * steps.toDouble, kernel.velocityNed(0).x)

  val quadrotorScalar: Work = Work("quadrotor, scalar", VehicleStep): _ =>
    val steps    = 1_000_000
    val state    = Quadrotor.AirSim.hovering(Vector3(0, 0, -20))
    val setpoint = Setpoint.velocityZ(10, 0, -20)
    for _ <- 1 to steps do Quadrotor.AirSim.step(state, setpoint)
    (steps.toDouble, state.vx)

  private val network = NeuralShape(Vector(8, 8))
  private val weights = Vector.tabulate(network.parameters)(i => math.sin(i))

  /** A searched network policy: pursuers with weights of their own, candidates of one episode. */
  val networkByLanes: Work = Work("network, candidates of 8 episodes", AgentStep): thread =>
    val worlds = 2048
    val flown  = Array.tabulate(256)(i => team(NeuralPolicy(network, weights.map(_ * (0.5 + i / 256.0)))))
    val all    = new TeamWorlds:
      def size: Int                            = worlds
      override def shareEpisodes: Boolean      = true
      def key(world: Int): Int                 = WorldRandom.key(thread, 0, world / 256)
      def link(world: Int): DelayTable         = DelayTable.vpn
      def candidate(world: Int): TeamCandidate = flown(world % 256)
    val outcomes = batch(LoopTiming.Stream(), 1).fly(all)
    (worlds * 1200.0, outcomes.values(0).map(_.toDouble).sum / worlds)

  val networkScalar: Work = Work("network, scalar", Decision): thread =>
    val steps  = 500_000
    val policy = NeuralPolicy(network, weights)
    var sum    = 0.0
    for i <- 1 to steps do
      sum += policy.turnRate((i % 512 + thread) * 0.01, i % 512 * 0.01, 0, 0, i % 512 * 0.01)
    (steps.toDouble, sum / steps)

  def batch(timing: LoopTiming, threads: Int): TeamBatch = TeamBatch(timing, model, threads)

  val duel: Engagement = Engagement.of(PaperDuel().fleet)

  /** The paper's duel with another pursuer, scored as in a search for the distance. */
  def team(pursuer: Policy): TeamCandidate =
    TeamCandidate(duel.flownBy(Role.Pursuer, pursuer), DistanceTerm.Last10s.judged(60, 0.1).toVector)

  /** Pursuers of different turn rates, `perEpisode` of them in each episode. */
  final class Candidates(val size: Int, perEpisode: Int, delays: DelayTable, seed: Long) extends TeamWorlds:
    override def shareEpisodes: Boolean      = perEpisode > 1
    def key(world: Int): Int                 = WorldRandom.key(seed, 0, world / perEpisode)
    def link(world: Int): DelayTable         = delays
    def candidate(world: Int): TeamCandidate = pursuers(world % pursuers.length)

  private val pursuers = Array.tabulate(1024)(i => team(PaperPursuer(0.8 + 0.4 * i / 1024)))
