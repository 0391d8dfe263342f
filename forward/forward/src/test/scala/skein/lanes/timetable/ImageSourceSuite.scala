package skein.lanes.timetable

import scala.collection.mutable.ArrayBuffer
import skein.forward.*
import skein.fusion.{Exposure, SensorModel}
import skein.optimise.LatencyBudget
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.Span
import skein.vehicle.ReducedModel

class ImageSourceSuite extends munit.FunSuite:
  import ImageSourceSuite.*

  private val camera  = GuideCamera.model
  private val cameras = Seq(
    "the guide's"                   -> camera,
    "of many images, one worker"    -> camera.copy(everyS = 0.03, workers = 1),
    "often too late for a deadline" -> camera.copy(
      everyS = 1.0 / 30,
      takes = LatencyDistribution.Uniform(Span.ofMillis(5), Span.ofMillis(400)),
      workers = 3
    )
  )

  private val links = Seq[(String, TabledDelays)](
    "none"                        -> DelayTable.none,
    "vpn"                         -> DelayTable.vpn,
    "150 ms and 150 ms of jitter" -> DelayTable.of(LatencyBudget.link(150, 150).get),
    "300 ms and 300 ms of jitter" -> DelayTable.of(LatencyBudget.link(300, 300).get),
    "a link that changes"         -> AlternatingDelays(DelayTable.vpn, DelayTable.direct, 1.0, 0.5)
  )

  for
    (what, model) <- cameras
    (name, link)  <- links
    agent         <- 0 to 1
  do
    test(
      s"a camera $what over $name, vehicle $agent: images equal those of the scalar engine, to the nanosecond"
    ):
      val source = ImageSource(model, agent, DurationS)
      var older  = 0
      for seed <- 1 to 3 do
        val key  = WorldRandom.key(seed, 0, 0)
        val seen = happens(model, agent, link, key)
        source.begin(key, link)
        for (other, number) <- seen.zipWithIndex do
          assertEquals(told(source), other, s"seed $seed, number $number")
          if !source.isTaken && source.order.isOlder then older += 1
          source.next()
        assert(seen.count(_.errors.isEmpty) > DurationS, s"seed $seed")
      if name.startsWith("300") then assert(older > 0, "no image was overtaken")

  private def told(source: ImageSource): Happens =
    Happens(
      source.image,
      source.atNs,
      Option.when(source.isTaken):
        if source.isFound then Some((source.bearing, source.range)) else None
    )

  private def happens(model: SensorModel, agent: Int, link: TabledDelays, key: Int): Vector[Happens] =
    val all      = ArrayBuffer.empty[Happens]
    val observer = new LoopObserver:
      override def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit =
        val errors = (SensorModel.normal(image.bearing).toFloat, SensorModel.normal(image.range).toFloat)
        all += Happens(number, atNs, Some(Option.when(image.found < model.detection)(errors)))
      override def recognised(vehicle: Int, image: Int, atNs: Long): Unit =
        all += Happens(image, atNs, None)
    val paper = Pair.paper.copy(durationS = DurationS)
    val duel  =
      if agent == 0 then paper.copy(evader = paper.evader.copy(eye = Some(model)))
      else paper.copy(pursuer = paper.pursuer.copy(eye = Some(model)))
    Rollout(
      duel.engagement,
      LoopTiming.stream(0.1),
      link,
      PlantResponse(ReducedModel.AirSimLag)
    ).fly(key, observer = observer): Unit
    all.toVector

private object ImageSourceSuite:
  private val DurationS = 12.0

  /** An event of an image.
    *
    * @param errors errors of an image that is taken, if an opponent in view is detected; None if an image's
    *   result becomes known
    */
  private final case class Happens(image: Int, atNs: Long, errors: Option[Option[(Float, Float)]])
