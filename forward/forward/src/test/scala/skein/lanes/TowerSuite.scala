package skein.lanes

import skein.forward.*
import skein.lanes.score.Judged
import skein.scenario.Reduction
import skein.simd.WorldRandom
import skein.testing.Optimised
import skein.vehicle.TiltModel

class TowerSuite extends munit.FunSuite, Optimised:
  test("SIMD simulates five drones around a tower, with a vector as memory, as the scalar engine does"):
    val model      = SpatialResponse(TiltModel.AirSim)
    val candidates = Vector.tabulate(8): number =>
      TeamCandidate(
        Engagement.inSpace(Tower(radiusM = 6 + 0.3 * number).fleet, 5),
        Vector(Judged(Tower.Kept(4), Reduction.Mean, 0), Judged(Tower.ApartInSpace, Reduction.Least, 1))
      )
    def flown(isReference: Boolean) =
      val batch  = TeamBatch(LoopTiming.Stream(), model, threads = 1, isReference = isReference)
      val engine = batch.engine(candidates.head, shareEpisodes = false, Seq(DelayTable.vpn))
      assertEquals(engine.fliesByLanes, !isReference, engine.text)
      batch.fly(new TeamWorlds:
        def size: Int                            = candidates.size
        def key(world: Int): Int                 = WorldRandom.key(7, 0, world)
        def link(world: Int): Delays             = DelayTable.vpn
        def candidate(world: Int): TeamCandidate = candidates(world)).values
    val (fast, slow) = (flown(isReference = false), flown(isReference = true))
    for number <- fast.indices; world <- candidates.indices do
      assertEqualsDouble(fast(number)(world).toDouble, slow(number)(world).toDouble, 1e-2, s"world $world")
