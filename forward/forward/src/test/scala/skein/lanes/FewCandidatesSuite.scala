package skein.lanes

import skein.forward.*
import skein.identify.Tilting
import skein.lanes.score.Judged
import skein.lanes.timetable.TimetableKernel
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.scenario.{OffRing, Reduction, Surround}
import skein.simd.WorldRandom
import skein.testing.Unhurried
import skein.vehicle.ReducedModel

/** Kernels compute no more worlds than there are candidates of an episode, as in a search that proposes a few
  * at a time. Their results are bit-identical to those among many.
  */
class FewCandidatesSuite extends munit.FunSuite, Unhurried:
  private val many = TimetableKernel.WORLDS
  // A little more than one vector.
  private val few = 17

  private val models = Seq(
    "lag"       -> PlantResponse(ReducedModel.AirSimLag),
    "drag"      -> PlantResponse(ReducedModel.AirSim),
    "tilting"   -> PlantResponse(Tilting(0.95, 0.9, 0.2)),
    "quadrotor" -> VelocityResponses.quadrotor()
  )

  private def loops(model: VelocityResponse) =
    Seq(LoopTiming.Stream(), LoopTiming.Sequential(), LoopTiming.Predictive(predictor = model.predictor))

  private def duels(duel: Duel, timing: LoopTiming, model: VelocityResponse, count: Int) =
    val batch = PairBatch(duel, timing, model, threads = 1)
    val came  = batch.fly(
      new PairWorlds:
        def size: Int                       = count
        override def shareEpisodes: Boolean = true
        def key(world: Int): Int            = WorldRandom.key(3, 1, 1)
        def link(world: Int): Delays        = DelayTable.vpn
        def pursuer(world: Int): Policy     = PaperPursuer(0.6 + 1e-2 * world)
        def evader(world: Int): Policy      = PaperEvader()
    )
    PairNumber.values.toVector.map(came(_).take(few).toVector)

  private def teams(timing: LoopTiming, model: VelocityResponse, count: Int) =
    TeamBatch(timing, model, threads = 1)
      .fly(
        new TeamWorlds:
          private val all = Vector.tabulate(count): world =>
            TeamCandidate(
              Engagement.of(Surround(3, ringM = 5 + 0.02 * world).fleet, 5),
              Vector(Judged(OffRing(5 + 0.02 * world), Reduction.Rms, 0))
            )
          def size: Int                            = count
          override def shareEpisodes: Boolean      = true
          def key(world: Int): Int                 = WorldRandom.key(5, 0, 1)
          def link(world: Int): Delays             = DelayTable.vpn
          def candidate(world: Int): TeamCandidate = all(world)
      )
      .values
      .map(_.take(few).toVector)

  private val short  = Duel.paper.copy(durationS = 12)
  private val seeing = short.copy(pursuer = short.pursuer.copy(eye = Some(GuideCamera.model)))

  for (name, model) <- models; timing <- loops(model) do
    test(s"duels: $name, ${timing.productPrefix}"):
      assertEquals(duels(short, timing, model, few), duels(short, timing, model, many))
    test(s"teams: $name, ${timing.productPrefix}"):
      assertEquals(teams(timing, model, few), teams(timing, model, many))

  for timing <- loops(models.head._2) do
    test(s"duels with one camera, ${timing.productPrefix}"):
      assertEquals(duels(seeing, timing, models.head._2, few), duels(seeing, timing, models.head._2, many))
