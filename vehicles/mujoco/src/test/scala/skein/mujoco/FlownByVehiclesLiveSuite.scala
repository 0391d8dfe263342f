package skein.mujoco

import skein.forward.*
import skein.lanes.*
import skein.lanes.score.Judged
import skein.policy.{PaperPursuer, Role}
import skein.scenario.{OffRing, PaperDuel, Reduction, Separation, Surround}
import skein.simd.WorldRandom

/** Checks the statement in docs/engines.md that MuJoCo bodies are simulated as vehicles. `FlownByLanesSuite`
  * checks its table for the plants that need nothing installed.
  */
class FlownByVehiclesLiveSuite extends MujocoHere:
  private lazy val model = MujocoResponse(MujocoRotorcraftLiveSuite.example("quadrotor"))

  private def loops = Vector[LoopTiming](
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  test("duels are simulated vehicle by vehicle under every loop, with the scalar engine's bits"):
    assumeMujoco()
    val game = Engagement.of(PaperDuel().fleet, 2)
    for timing <- loops; shared <- Seq(true, false) do
      val told  = s"${timing.productPrefix}, shared delays: $shared"
      val batch = TeamBatch(timing, model, threads = 1)
      val all   = new TeamWorlds:
        private val teams = Vector.tabulate(3): world =>
          val pursued = game.flownBy(Role.Pursuer, PaperPursuer(0.6 + 0.04 * world))
          TeamCandidate(pursued, Vector(Judged(Separation, Reduction.Mean, 0)))
        def size: Int                            = 3
        override def shareEpisodes: Boolean      = shared
        def key(world: Int): Int                 = WorldRandom.key(5, 0, if shared then 1 else world)
        def link(world: Int): Delays             = DelayTable.vpn
        def candidate(world: Int): TeamCandidate = teams(world)
      val engine = batch.engine(all.candidate(0), shared, Seq(DelayTable.vpn)).text
      assertEquals(engine, "vehicles side by side; their loops by the scalar engine", told)
      val flown = batch.fly(all).values(0)
      for world <- 0 until all.size do
        val scalar = ScalarTeam(timing, model).fly(all.candidate(world), DelayTable.vpn, all.key(world))(0)
        assertEquals(flown(world), scalar.toFloat, s"$told, world $world")

  test("teams are simulated vehicle by vehicle under every loop, with the scalar engine's bits"):
    assumeMujoco()
    val surround = Surround(4)
    val judged   = Vector(Judged(OffRing(surround.ringM), Reduction.Rms, 0))
    val team     = TeamCandidate(Engagement.of(surround.fleet, 1), judged)
    for timing <- loops; shared <- Seq(true, false) do
      val told  = s"${timing.productPrefix}, shared delays: $shared"
      val batch = TeamBatch(timing, model, threads = 1)
      assertEquals(
        batch.engine(team, shared, Seq(DelayTable.vpn)).text,
        "vehicles side by side; their loops by the scalar engine",
        told
      )
      val all = new TeamWorlds:
        def size: Int                            = 18
        override def shareEpisodes: Boolean      = shared
        def key(world: Int): Int                 = WorldRandom.key(5, 0, world)
        def link(world: Int): Delays             = DelayTable.vpn
        def candidate(world: Int): TeamCandidate = team
      val flown  = batch.fly(all).values(0)
      val scalar = ScalarTeam(timing, model)
      for world <- 0 until all.size by 17 do
        val truth = scalar.fly(team, DelayTable.vpn, all.key(world))(0)
        assertEquals(flown(world), truth.toFloat, s"$told, world $world")
