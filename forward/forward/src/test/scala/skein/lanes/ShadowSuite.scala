package skein.lanes

import skein.forward.*
import skein.lanes.score.Judged
import skein.scenario.{Reduction, Shadow}
import skein.simd.WorldRandom
import skein.testing.Optimised
import skein.vehicle.TiltModel

class ShadowSuite extends munit.FunSuite, Optimised:
  test("SIMD simulates a weaving leader and its follower as the scalar engine does"):
    val candidates = Vector.tabulate(8): number =>
      TeamCandidate(
        Engagement.inSpace(Shadow(course = number + 1, leaderMps = 5 + 0.2 * number).fleet, 10),
        Vector(Judged(Shadow.Beside(5), Reduction.Rms, 2))
      )
    def flown(isReference: Boolean) =
      val batch =
        TeamBatch(
          LoopTiming.Stream(),
          SpatialResponse(TiltModel.AirSim),
          threads = 1,
          isReference = isReference
        )
      val engine = batch.engine(candidates.head, shareEpisodes = false, Seq(DelayTable.vpn))
      assertEquals(engine.fliesByLanes, !isReference, engine.text)
      batch.fly(new TeamWorlds:
        def size: Int                            = candidates.size
        def key(world: Int): Int                 = WorldRandom.key(7, 0, world)
        def link(world: Int): Delays             = DelayTable.vpn
        def candidate(world: Int): TeamCandidate = candidates(world)).values
    val (fast, slow) = (flown(isReference = false), flown(isReference = true))
    for world <- candidates.indices do
      assertEqualsDouble(fast(0)(world).toDouble, slow(0)(world).toDouble, 1e-2, s"world $world")
    assert(slow(0).distinct.length > 4, slow(0).mkString(", "))
