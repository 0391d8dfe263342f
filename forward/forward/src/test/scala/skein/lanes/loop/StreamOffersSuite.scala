package skein.lanes.loop

import scala.collection.mutable.ArrayBuffer
import skein.forward.{AlternatingDelays, DelayTable, LinkDelays, LoopTiming, TabledDelays}
import skein.optimise.LatencyBudget
import skein.signal.LatencyProfile
import skein.simd.WorldRandom
import skein.vehicle.SensorNoise

class StreamOffersSuite extends munit.FunSuite:
  private val worlds    = LaneOffers.WORLDS
  private val durationS = 30.0
  private val keys      = Array.tabulate(worlds)(WorldRandom.key(6, 0, _))

  /** A view: its times from the flight's start, in grains, and its indices relative to those of the first
    * request.
    */
  private final case class Told(
      joinedAt: Long,
      nextAt: Option[Long],
      sampledAt: Vector[Long],
      isFresh: Vector[Boolean],
      place: Vector[Int]
  )

  private def views(
      timing: LoopTiming.Stream,
      vehicles: Int,
      links: Array[TabledDelays],
      shortCut: Boolean,
      noise: SensorNoise
  ): Vector[Vector[Told]] =
    val missing = MissingReadings(Array.fill(vehicles)(noise))
    if noise != null then missing.start(keys)
    val offers = StreamOffers(timing, vehicles, durationS, links.map(_.maxS).max, shortCut, missing)
    val told   = Vector.fill(worlds)(ArrayBuffer.empty[Told])
    val rows   = (durationS / timing.periodS).round.toInt
    val period = LaneViews.grains(timing.periodS).toLong
    val team   = (0 until vehicles).toVector
    def isNew(vehicle: Int, world: Int) = offers.fresh(vehicle) == null || offers.fresh(vehicle)(world) > 0
    offers.start(keys, links)
    for row <- 0 until rows do
      offers.startRow(row)
      while offers.nextBeat() do
        for world <- 0 until worlds if offers.joinedAt(world) != LaneOffers.NONE do
          val begin                 = row * period
          def times(of: Array[Int]) = begin + of(world)
          told(world) += Told(
            times(offers.joinedAt),
            Option.when(times(offers.nextAt) < durationS * 1e9 / DelayTable.GrainNs)(times(offers.nextAt)),
            team.map(v => times(offers.sampledAt(v))),
            team.map(isNew(_, world)),
            team.map(v => LaneDelays.placeOf(row) + offers.place(v)(world))
          )
    told.map(_.toVector)

  private def wild(meanMs: Double, jitterMs: Double) = DelayTable.of(LatencyBudget.link(meanMs, jitterMs).get)

  private val steady = Seq(
    (36.0, 22.0),
    (103.0, 66.0),
    (110.0, 60.0),
    (215.0, 36.0),
    (190.0, 90.0),
    (150.0, 150.0),
    (300.0, 300.0)
  ).map((mean, jitter) => s"$mean ms and $jitter ms of jitter" -> wild(mean, jitter))

  private val changing = Seq(
    "vpn and direct"  -> AlternatingDelays(DelayTable.vpn, DelayTable.direct, 4, 2),
    "slow and direct" -> AlternatingDelays(wild(300, 300), DelayTable.direct, 1, 0.5)
  ).map((name, link) => s"$name in turns" -> link)

  private val losing =
    Seq("loss:5%,vpn", "loss:5%/4,outage:1s/10s,vpn", "loss:10%,constant:80ms").map: text =>
      val link = LatencyProfile.parse(
        text,
        Left(_)
      ).flatMap(LinkDelays.checked(_, LoopTiming.stream(0.1), vehicles = 2))
      text -> link.toOption.collect { case delays: TabledDelays => delays }.get

  for
    vehicles    <- Seq(2, 3, 6)
    (name, bad) <- steady ++ changing ++ losing
  do
    test(s"$vehicles vehicles, $name: views with SIMD equal those computed one by one"):
      agree(vehicles, bad)

  for
    vehicles     <- Seq(2, 3)
    (name, link) <- Seq("none" -> DelayTable.none, "vpn" -> DelayTable.vpn, steady.head)
    text         <- Seq("dropout=5%", "dropout=60%", "outage=1s/3s,dropout=2%")
  do
    test(s"$vehicles vehicles, $name, readings with $text: views with SIMD equal those computed one by one"):
      agree(vehicles, link, SensorNoise.parse(text).fold(fail(_), identity), leastHz = 0.1)

  private def agree(vehicles: Int, bad: TabledDelays, noise: SensorNoise = null, leastHz: Double = 5): Unit =
    val timing = LoopTiming.stream(0.1)
    // In neighbouring lanes with links without any irregularity.
    val good    = if bad.isInstanceOf[DelayTable] && noise == null then DelayTable.none else DelayTable.direct
    val links   = Array.tabulate[TabledDelays](worlds)(world => if world % 3 == 0 then good else bad)
    val byLanes = views(timing, vehicles, links, shortCut = true, noise)
    val oneByOne = views(timing, vehicles, links, shortCut = false, noise)
    // Views are reported early, so the last ones are reported although they are joined after the flight's
    // end.
    val within = (durationS - 1) * 1e9 / DelayTable.GrainNs
    for world <- 0 until worlds do
      val (these, those) = (byLanes(world), oneByOne(world))
      for ((one, other), number) <- these.zip(those).zipWithIndex if other.joinedAt < within do
        assertEquals(one, other, s"world $world, view $number")
      assertEquals(these.count(_.joinedAt < within), those.count(_.joinedAt < within), s"world $world")
      assert(these.size > durationS * leastHz, s"world $world: ${these.size} views")
