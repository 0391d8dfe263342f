package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.formula.ErrorBound
import skein.forward.*
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.units.Instant

/** Pursuers that know of their evaders by a sensor's model alone: lanes and the scalar engine find the evader
  * in the same images of every world, and take the same decisions; but where a bearing, a range, or a number
  * that a policy compares lies so near to a threshold that rounding decides.
  */
class CameraTrackerAgreementSimulation extends munit.FunSuite:
  import CameraTrackerAgreementSimulation.*
  import DuelAgreement.Event

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
      val lanes    = DuelAgreement.taken(pursuer, evader)
      val vehicles = LaneDynamics.under(timing, model, duel).fold(fail(_), identity)
      val flown    = TimetableDuels(duel, timing, vehicles, lanes(1), lanes(0), DuelNumber.all, eye, null)
      flown.fly(
        Timetable.of(2, duel.durationS, timing, DelayTable.vpn, key, vehicles, Map(1 -> camera)),
        worlds,
        0
      )
      isFlownByBatch(timing, key, flown)
      val agreement = new DuelAgreement(
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
          if looked.k < eye.looks.size then found(looked, eye.looks(looked.k), world) else None
      agreement.check(s"episode $episode", 0 until worlds by 5)

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
    assertEquals(batch.fly(all).meanDistanceM.toSeq, kernel(DuelNumber.MeanDistance).toSeq)

  /** Where an image shows an opponent to the one and not to the other. */
  private def found(event: Event.Looked, lanes: Looked, world: Int): Option[Agreement.Departure] =
    val scalar  = event.exposure
    val isFound = camera.measured(Instant.Epoch, scalar).isDefined
    val doubles =
      Array(scalar.axisRad, scalar.ownNed.x, scalar.ownNed.y, scalar.ownNed.z) ++
        Array(scalar.opponentNed.x, scalar.opponentNed.y, scalar.opponentNed.z, 0.0, 0.0)
    val floats = lanes.inputs(world)
    floats(0) += 2 * math.Pi * math.rint((doubles(0) - floats(0)) / (2 * math.Pi))
    // Until decisions part, all is where it is in doubles.
    val away = doubles.zip(floats).map((x, y) => math.abs(x - y))
    assert(away.max < Agreement.mostOff(event.timeS), s"world $world: ${away.mkString(", ")} off")
    Option.when(isFound != (lanes.found(world) > 0)):
      val detected = lanes.by.detected
      val shown    = Seq(detected.bound.nodes(0))
      val inputs   = detected.inputsOf(doubles)
      val off      = inputs.zip(detected.inputsOf(floats)).map((x, y) => math.abs(x - y))
      // The number drawn is exact; beyond the probability of detection nothing is found.
      val drawn = scalar.found < camera.detection
      val near  =
        if drawn then ErrorBound.of(shown, inputs, off, detected.parameters).undecided(shown)
        else Vector.empty
      Agreement.Departure(1, event.k, event.timeS, Vector(1.0 -> 1.0), near)

private object CameraTrackerAgreementSimulation:
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
