package skein.lanes.gpu

import skein.forward.{DelayTable, LoopTiming, PlantResponse}
import skein.gpu.InterpretedGpu
import skein.lanes.*
import skein.lanes.timetable.Timetable
import skein.simd.WorldRandom
import skein.vehicle.ReducedModel

class GpuEpisodesSuite extends munit.FunSuite:
  private val model =
    LaneDynamics.of(PlantResponse(ReducedModel.AirSimLag)).fold(fail(_), identity)

  private def timetable(key: Int): Timetable =
    Timetable.of(Vector.fill(2)(model), 2, LoopTiming.Stream(), DelayTable.vpn, WorldRandom.key(1, 0, key))

  private def episodes(mostBytes: Long) =
    GpuEpisodes(InterpretedGpu(), 2, shows = false, threads = 1, mostBytes)

  test("the episodes of a call stay cached, however small the limit; unused ones are evicted"):
    val held              = episodes(mostBytes = 1)
    var made              = Vector.empty[Int]
    def bring(keys: Int*) = held.bring(keys.toVector, () => false): i =>
      made :+= keys(i)
      timetable(keys(i))
    val first  = bring(1, 2).get
    val second = bring(2, 3).get
    assertEquals(second(0), first(1))
    assertEquals(made, Vector(1, 2, 3))
    bring(2, 1): Unit
    assertEquals(made, Vector(1, 2, 3, 1))

  test("if an episode needs a larger layout, no timetable is made twice"):
    val held = episodes(mostBytes = 1 << 20)
    var made = 0
    val some = held.bring(Vector("small", "large"), () => false): i =>
      made += 1
      val plain = timetable(1)
      import plain.*
      Timetable(
        vehicles,
        operations,
        numbers,
        times,
        views,
        propagations,
        if i == 0 then readings else 6,
        headings
      )
    assertEquals(made, 2)
    assertEquals(held.layout.readings, 8)
    assert(some.get.forall(_ != null))

  test("a cancelled call uploads nothing"):
    assertEquals(episodes(1 << 20).bring(Vector(1), () => true)(timetable(_)), None)

  test("a number of worlds that is not a multiple of the episodes is refused"):
    val worlds = new Worlds:
      def size: Int                    = 5
      override def episodesOfEach: Int = 2
      def key(world: Int): Int         = 0
      def link(world: Int): DelayTable = DelayTable.vpn
    interceptMessage[IllegalArgumentException](
      "requirement failed: 5 worlds are not 2 episodes of every candidate"
    )(GpuEpisodes.candidatesOf(worlds))
