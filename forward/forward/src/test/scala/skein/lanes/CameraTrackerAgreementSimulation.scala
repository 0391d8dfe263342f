package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.formula.ErrorBound
import skein.forward.*
import skein.lanes.loop.{LaneAgents, LoopEye, LoopLanes}
import skein.lanes.policy.CameraTrackerLanes
import skein.lanes.timetable.{TimetableEye, TimetableVehicles}
import skein.optimise.LatencyBudget
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.testing.Lengthy
import skein.units.Instant
import skein.vehicle.ReducedModel

/** Pursuers whose only knowledge of their evaders is a sensor's model: SIMD and the scalar engine find the
  * evader in equal images of every world, and take equal decisions, except where a bearing, a range, or a
  * number that a policy compares is so near to a threshold that rounding decides.
  */
class CameraTrackerAgreementSimulation extends CameraTrackerAgreement(isDaily = true)

/** The other combinations. */
class CameraTrackerCombinationsSimulation extends CameraTrackerAgreement(isDaily = false), Lengthy

abstract class CameraTrackerAgreement(isDaily: Boolean) extends munit.FunSuite:
  import CameraTrackerAgreement.*
  import PairAgreement.Event

  private val worlds = PairKernels.WORLDS
  private val model  = PlantResponse(ReducedModel.AirSimLag)
  private val camera = GuideCamera.model

  // To the side of the pursuer's way, so that rounding does not decide the side of any turn.
  private val duel = Pair.paper.copy(
    pursuer = Pair.paper.pursuer.copy(eye = Some(camera)),
    evader = Pair.paper.evader.copy(startY = 2),
    durationS = 12
  )

  private val seeingPursuer = duel.copy(durationS = 6)
  private val seeingEvader  =
    seeingPursuer.copy(pursuer = Pair.paper.pursuer, evader = duel.evader.copy(eye = Some(camera)))

  private val plants = Seq[(String, VelocityResponse)](
    "lag"    -> VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05),
    "no lag" -> VelocityResponses.Ideal,
    "drag"   -> PlantResponse(ReducedModel.AirSim),
    "car"    -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4))
  )

  private def ownLoops(model: VelocityResponse) = Seq(
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.stream(0.1),
    LoopTiming.Stream(decideThenPace = true),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  private def wild(meanMs: Double, jitterMs: Double) = DelayTable.of(LatencyBudget.link(meanMs, jitterMs).get)

  private def isWild(name: String) = name.startsWith("300 ms")

  private val links = Seq[(String, TabledDelays)](
    "none"                        -> DelayTable.none,
    "direct"                      -> DelayTable.direct,
    "vpn"                         -> DelayTable.vpn,
    "110 ms and 60 ms of jitter"  -> wild(110, 60),
    "300 ms and 300 ms of jitter" -> wild(300, 300),
    "a link that changes"         -> AlternatingDelays(wild(150, 150), DelayTable.direct, 1.0, 0.5)
  )

  private def pursuer(world: Int): Policy = PaperPursuer(0.6 + 0.004 * (world % 128))
  private def evader(world: Int): Policy  = PaperEvader(7 + 0.01 * (world % 128))

  for
    timing <- Seq(
      LoopTiming.Paused(),
      LoopTiming.Sequential(),
      LoopTiming.Futures(),
      LoopTiming.stream(0.1),
      LoopTiming.Predictive(predictor = model.predictor)
    )
    episode <- 0 until 2
    if isDaily == (episode == 0)
  do
    test(s"${timing.productPrefix}, episode $episode: equal detections and decisions in each world compared"):
      val key   = WorldRandom.key(5, 0, episode)
      val forms = CameraTrackerLanes.of(camera).fold(fail(_), identity)
      val eye   = SharedEye(forms, duel.pursuer, duel.evader)
      val lanes = PairAgreement.taken(pursuer, evader)
      val flown = PairKernels.shared(duel, timing, model, lanes, DelayTable.vpn, key, 0, Map(1 -> eye))
      isFlownByBatch(timing, key, flown)
      val agreement = new PairAgreement(
        duel,
        timing,
        model,
        _ => DelayTable.vpn,
        _ => key,
        0,
        Vector(evader, pursuer),
        lanes,
        flown
      ):
        override def difference(looked: Event.Looked, world: Int): Option[Agreement.Departure] =
          if looked.k < eye.looks.size then found(looked, eye.looks(looked.k)(world)) else None
      agreement.check(s"episode $episode", 0 until worlds by 5)

  /** The batch of forward simulation gives these results, to the bit. */
  private def isFlownByBatch(timing: LoopTiming, episode: Int, kernel: PairKernel): Unit =
    val all = new PairWorlds:
      def size: Int                       = worlds
      override def shareEpisodes: Boolean = true
      def key(world: Int): Int            = episode
      def link(world: Int): Delays        = DelayTable.vpn
      def pursuer(world: Int): Policy     = CameraTrackerAgreement.this.pursuer(world)
      def evader(world: Int): Policy      = CameraTrackerAgreement.this.evader(world)
    val batch = PairBatch(duel, timing, model, threads = 1)
    val told  = batch.engine(pursuer(0), evader(0), shareEpisodes = true, Seq(DelayTable.vpn)).text
    assert(told.startsWith("SIMD"), told)
    assertEquals(batch.fly(all).meanDistanceM.toSeq, kernel(PairNumber.MeanDistance).toSeq)

  for
    (plant, model) <- plants
    timing         <- ownLoops(model)
    (name, link)   <- links
    (who, seeing)  <- Seq("pursuer" -> seeingPursuer, "evader" -> seeingEvader)
    isStream = timing.isInstanceOf[LoopTiming.Stream]
    if (plant, who) match
      case ("lag", "pursuer") => isStream || name == "vpn" || isWild(name)
      case ("lag", _)         => name == "vpn"
      case (_, who)           => who == "pursuer" && name == "vpn" && timing != LoopTiming.Sequential()
    if isDaily == (plant == "lag" && name == "vpn" || isStream && isWild(name) || plant == "drag")
  do
    test(
      s"separate delays, $plant, $timing over $name, camera of the $who: equal detections and decisions in each world"
    ):
      agreeAlone(seeing, timing, model, link)

  for timing <- Seq(LoopTiming.Sequential(2.5), LoopTiming.Futures(0.03), LoopTiming.stream(0.03)) if isDaily
  do
    test(
      s"separate delays, $timing, images every 30 ms: equal detections and decisions in each world compared"
    ):
      val often = camera.copy(everyS = 1.0 / 30)
      agreeAlone(
        seeingPursuer.copy(pursuer = seeingPursuer.pursuer.copy(eye = Some(often))),
        timing,
        PlantResponse(ReducedModel.AirSimLag),
        DelayTable.vpn
      )

  private def agreeAlone(
      seeing: Pair,
      timing: LoopTiming,
      model: VelocityResponse,
      link: TabledDelays
  ): Unit =
    val seed            = 8
    val lanes           = PairAgreement.taken(pursuer, evader)
    var eye: OwnEye     = null
    def key(world: Int) = WorldRandom.key(seed, 0, world)
    val flown           = PairAgreement.flownAlone(
      seeing,
      timing,
      model,
      _ => link,
      key(_),
      0,
      lanes,
      (forms, own, opponent, loop, ours, theirs) =>
        eye = OwnEye(forms, own, opponent, loop, ours, theirs)
        eye
    )
    val agreement = new PairAgreement(
      seeing,
      timing,
      model,
      _ => link,
      key(_),
      0,
      Vector(evader, pursuer),
      lanes,
      flown
    ):
      override def difference(looked: Event.Looked, world: Int): Option[Agreement.Departure] =
        eye.looks(world).lift(looked.k).flatMap: lanes =>
          assertEquals(lanes.timeS, looked.timeS, s"seed $seed, world $world, image ${looked.k}")
          found(looked, lanes)
    agreement.check(s"seed $seed", 0 until worlds by 16, atLeast = 4)
    for (looks, world) <- eye.looks.zipWithIndex do
      assert(looks.size > seeing.durationS, s"seed $seed, world $world: ${looks.size} images")

  /** The difference where an image shows an opponent in one engine only. */
  private def found(event: Event.Looked, lanes: Looked): Option[Agreement.Departure] =
    val scalar  = event.exposure
    val isFound = camera.measured(Instant.Epoch, scalar).isDefined
    val doubles =
      Array(scalar.axisRad, scalar.ownNed.x, scalar.ownNed.y, scalar.ownNed.z) ++
        Array(scalar.opponentNed.x, scalar.opponentNed.y, scalar.opponentNed.z, 0.0, 0.0)
    val floats = lanes.inputs.clone
    floats(0) += 2 * math.Pi * math.rint((doubles(0) - floats(0)) / (2 * math.Pi))
    // Until decisions differ, all positions are those in doubles.
    val away = doubles.zip(floats).map((x, y) => math.abs(x - y))
    assert(away.max < Agreement.mostOff(event.timeS), s"at ${event.timeS} s: ${away.mkString(", ")} off")
    Option.when(isFound != lanes.isFound):
      val detected = lanes.by.detected
      val shown    = Seq(detected.bound.nodes(0))
      val inputs   = detected.bound.inputs.map(doubles(_))
      val off      = inputs.zip(detected.bound.inputs.map(floats(_))).map((x, y) => math.abs(x - y))
      // The number drawn is exact; beyond the probability of detection nothing is found.
      val drawn = scalar.found < camera.detection
      val near  =
        if drawn then ErrorBound.of(shown, inputs, off, detected.parameters).undecided(shown)
        else Vector.empty
      Agreement.Departure(1, event.k, event.timeS, Vector(1.0 -> 1.0), near)

private object CameraTrackerAgreement:
  /** An image of the SIMD engine in a world.
    *
    * @param inputs inputs of the sensor's formula, without errors
    */
  final class Looked(
      val by: CameraTrackerLanes.Forms,
      val timeS: Double,
      val inputs: Array[Double],
      val isFound: Boolean
  )

  private def inputs(axis: Double, ownX: Double, ownY: Double, x: Double, y: Double, down: Double) =
    Array(axis, ownX, ownY, down, x, y, down, 0.0, 0.0)

  final class SharedEye(forms: CameraTrackerLanes.Forms, own: RolloutAgent, opponent: RolloutAgent)
      extends TimetableEye(forms, own, opponent):
    val looks: ArrayBuffer[Vector[Looked]] = ArrayBuffer.empty

    override def expose(
        image: Int,
        ours: TimetableVehicles,
        oursAt: Int,
        theirs: TimetableVehicles,
        theirsAt: Int,
        times: Array[Float],
        at: Int
    ): Unit =
      super.expose(image, ours, oursAt, theirs, theirsAt, times, at)
      val shown = found(image)
      looks += Vector.tabulate(PairKernels.WORLDS): world =>
        val (we, they) = (oursAt + world, theirsAt + world)
        Looked(
          forms,
          times(at),
          inputs(
            axis(world),
            ours.seen(0)(we),
            ours.seen(1)(we),
            theirs.seen(0)(they),
            theirs.seen(1)(they),
            own.altitudeDownM
          ),
          shown(world) > 0
        )

  final class OwnEye(
      forms: CameraTrackerLanes.Forms,
      own: RolloutAgent,
      opponent: RolloutAgent,
      loop: LoopLanes,
      ours: LaneAgents,
      theirs: LaneAgents
  ) extends LoopEye(forms, own, opponent, loop, ours, theirs):
    val looks: Vector[ArrayBuffer[Looked]] = Vector.fill(PairKernels.WORLDS)(ArrayBuffer.empty)

    override def keep(n: Int, world: Int): Unit =
      super.keep(n, world)
      looks(world) += Looked(
        forms,
        takenNs(n)(world) * 1e-9,
        inputs(axis(world), ourX(world), ourY(world), theirX(world), theirY(world), own.altitudeDownM),
        isFound(n)(world) && shown(world) > 0
      )
