package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.formula.{ErrorBound, Node, Trace}
import skein.forward.*
import skein.fusion.Exposure
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.units.Instant

/** Pursuers that know of their evaders by a sensor's model alone: lanes and the scalar engine find the evader in the same
  * images of every world, and take the same decisions; but where a bearing, a range, or a number that a policy compares
  * lies so near to a threshold that rounding decides.
  */
class CameraTrackerAgreementSimulation extends munit.FunSuite:
  import CameraTrackerAgreementSimulation.*
  import AgreementSimulation.{Log, Logged}

  private val worlds = DuelKernel.WORLDS
  private val model  = Reduced.AirSim
  private val camera = GuideCamera.model

  // Beside the pursuer's way, so that no rounding decides to which side anybody turns.
  private val duel = Duel.paper.copy(
    pursuer = Duel.paper.pursuer.copy(eye = Some(camera)),
    evader = Duel.paper.evader.copy(startY = 2),
    durationS = 12
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
  do
    test(s"${timing.productPrefix}, episode $episode: the same is found and decided in each world compared"):
      val key      = WorldRandom.key(5, 0, episode)
      val forms    = CameraTrackerLanes.of(camera).fold(fail(_), identity)
      val eye      = LoggedEye(forms, duel.pursuer, duel.evader)
      val lanes    = Vector(Logged(evader(0)), Logged(pursuer(0)))
      val vehicles = LaneDynamics.under(timing, model, duel).fold(fail(_), identity)
      for world <- 0 until worlds do
        lanes(0).take(world, evader(world))
        lanes(1).take(world, pursuer(world))
      val flown = TimetableDuels(duel, timing, vehicles, lanes(1), lanes(0), eye, null)
      flown.fly(
        Timetable.of(2, duel.durationS, timing, DelayTable.vpn, key, vehicles, Map(1 -> camera)),
        worlds,
        0
      )
      isFlownByBatch(timing, key, flown)
      var same, parted = 0
      for world <- 0 until worlds by 5 do
        val policies = Vector(evader(world), pursuer(world))
        val logs     = policies.map(Log(_))
        val events   = Events()
        val scalar   =
          duel.copy(duel.pursuer.copy(policy = logs(1)), duel.evader.copy(policy = logs(0)))
        val outcome = Rollout(scalar, timing, DelayTable.vpn, model).fly(key, observer = events)
        val differs = events.all.iterator
          .flatMap:
            case Event.Decided(agent, k, timeS) =>
              Option
                .when(k < lanes(agent).made.size):
                  AgreementSimulation.difference(agent, k, policies(agent), logs(agent), lanes(agent), world)
                .flatten
                .map(found => (found.isUndecided, s"$timeS s: $found"))
            case Event.Looked(k, timeS, exposure) =>
              Option
                .when(k < eye.looks.size)(difference(exposure, eye.looks(k), world))
                .flatten
                .map(found => (found.isUndecided, s"$timeS s, image $k: $found"))
          .nextOption()
        differs match
          case None =>
            same += 1
            assertEqualsDouble(flown.meanDistance(world), outcome.meanDistanceM, 5e-3, s"world $world")
            assertEqualsDouble(flown.pursuerEffortRad(world), outcome.pursuerEffortRad, 5e-3, s"world $world")
          case Some((isUndecided, told)) =>
            parted += 1
            assert(isUndecided, s"world $world of episode $episode, at $told")
      assert(same > 0, s"in all $parted worlds rounding decided sooner or later")

  /** What the front of forward simulation flies is this, to the bit. */
  private def isFlownByBatch(timing: LoopTiming, episode: Int, kernel: DuelKernel): Unit =
    val all = new DuelWorlds:
      def size: Int                       = worlds
      override def shareEpisodes: Boolean = true
      def key(world: Int): Int            = episode
      def link(world: Int): Delays        = DelayTable.vpn
      def pursuer(world: Int): Policy     = CameraTrackerAgreementSimulation.this.pursuer(world)
      def evader(world: Int): Policy      = CameraTrackerAgreementSimulation.this.evader(world)
    val batch = DuelBatch(duel, timing, model, threads = 1)
    val told  = batch.engine(pursuer(0), evader(0), shareEpisodes = true, Seq(DelayTable.vpn))
    assert(told.startsWith("SIMD"), told)
    assertEquals(batch.fly(all).meanDistanceM.toSeq, kernel.meanDistance.toSeq)

  /** Where an image shows an opponent to the one and not to the other. */
  private def difference(scalar: Exposure, lanes: Looked, world: Int): Option[Difference] =
    val isFound = camera.measured(Instant.Epoch, scalar).isDefined
    val doubles =
      Array(scalar.axisRad, scalar.ownNed.x, scalar.ownNed.y, scalar.ownNed.z) ++
        Array(scalar.opponentNed.x, scalar.opponentNed.y, scalar.opponentNed.z, 0.0, 0.0)
    val floats = lanes.inputs(world)
    floats(0) += 2 * math.Pi * math.rint((doubles(0) - floats(0)) / (2 * math.Pi))
    // Until decisions part, all is where it is in doubles.
    val away = doubles.zip(floats).map((x, y) => math.abs(x - y))
    assert(away(0) < MostOffRad && away.tail.max < MostOffM, s"world $world: ${away.mkString(", ")} off")
    Option.when(isFound != (lanes.found(world) > 0)):
      val detected = lanes.by.detected
      val shown    = Seq(detected.bound.nodes(0))
      val inputs   = detected.inputsOf(doubles)
      val off      = inputs.zip(detected.inputsOf(floats)).map((x, y) => math.abs(x - y))
      val bound    = ErrorBound.of(shown, inputs, off, Array.emptyDoubleArray)
      val drawn    = scalar.found < camera.detection
      val compared = Trace
        .needed(shown)
        .filter(node => node.op.isCondition && node.args.size == 2 && !node.args.head.op.isCondition)
        .map: node =>
          val Vector(a, b) = node.args
          Compared(node, math.abs(bound.value(a) - bound.value(b)), bound.error(a) + bound.error(b))
      Difference(isFound, scalar.found - camera.detection, compared, drawn && bound.undecided(shown).nonEmpty)

private object CameraTrackerAgreementSimulation:
  /** Of what floats add up to in the vehicles' flight, and in what is believed of the opponent. */
  private val MostOffM   = 5e-3
  private val MostOffRad = 5e-3

  /** A comparison of what is seen with what can be seen: how near both sides are, and how far floats may be off. */
  final case class Compared(threshold: Node, margin: Double, bound: Double)

  /** @param isFound
    *   by the scalar engine, not by lanes; or else the other way
    * @param drawn
    *   the number drawn less the probability of detection, which is exact
    */
  final case class Difference(
      isFound: Boolean,
      drawn: Double,
      compared: Vector[Compared],
      isUndecided: Boolean
  )

  enum Event:
    case Decided(agent: Int, k: Int, timeS: Double)
    case Looked(k: Int, timeS: Double, exposure: Exposure)

  /** What the scalar engine decides and looks at, in turn. */
  final class Events extends LoopObserver:
    val all: ArrayBuffer[Event] = ArrayBuffer.empty
    private val decisions       = Array(0, 0)
    private var looks           = 0

    override def decided(vehicle: Int, atNs: Long, elapsedS: Double, upon: Grounds): Unit =
      all += Event.Decided(vehicle, decisions(vehicle), atNs * 1e-9)
      decisions(vehicle) += 1

    override def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit =
      all += Event.Looked(looks, atNs * 1e-9, image)
      looks += 1

  /** An image that the lanes took, by world. */
  final class Looked(
      val by: CameraTrackerLanes.Forms,
      axis: Array[Float],
      places: Vector[Array[Float]],
      down: Double
  )(
      val found: Array[Float]
  ):
    /** As the sensor's formula takes them, without errors. */
    def inputs(world: Int): Array[Double] =
      def at(i: Int) = places(i)(world).toDouble
      Array(axis(world).toDouble, at(0), at(1), down, at(2), at(3), down, 0, 0)

  final class LoggedEye(forms: CameraTrackerLanes.Forms, own: Duelist, opponent: Duelist)
      extends CameraTrackerLanes(forms, own, opponent):
    val looks: ArrayBuffer[Looked] = ArrayBuffer.empty

    override def expose(
        image: Int,
        ours: TimetableVehicles,
        oursAt: Int,
        theirs: TimetableVehicles,
        theirsAt: Int,
        times: Array[Float],
        at: Int
    ): Unit =
      def copied(from: Array[Float], at: Int) = java.util.Arrays.copyOfRange(from, at, at + DuelKernel.WORLDS)
      val places                              = Vector(
        copied(ours.seenX, oursAt),
        copied(ours.seenY, oursAt),
        copied(theirs.seenX, theirsAt),
        copied(theirs.seenY, theirsAt)
      )
      super.expose(image, ours, oursAt, theirs, theirsAt, times, at)
      looks += Looked(forms, axis.clone, places, own.altitudeDownM)(found(image))
